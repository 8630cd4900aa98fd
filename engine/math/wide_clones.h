// Compiles a function thrice, for AVX-512, AVX2 and every x86-64; the dynamic loader takes the one for the processor. All give the
// same bits. The thread sanitizer would instrument the choice, which is made before its runtime stands: with it there is one.
#pragma once

#if defined(__x86_64__) && !defined(__SANITIZE_THREAD__)
#define CRASHREEL_WIDE_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define CRASHREEL_WIDE_CLONES
#endif
