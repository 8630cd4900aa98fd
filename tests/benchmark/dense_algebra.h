#pragma once

/// Prints what our dense algebra takes beside Eigen's for the same: the reason why it is ours.
void dense_algebra_beside_eigen();
