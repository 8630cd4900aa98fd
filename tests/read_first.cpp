// Nothing: a target that lends its precompiled headers needs a source.
