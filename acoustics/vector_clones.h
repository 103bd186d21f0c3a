#pragma once

/// Before a function whose loops are worth it: it is compiled twice, for the base instruction set and for
/// registers of 256 bits, and the program picks at its start. The bits are the same: without -ffast-math no
/// sum is reordered, and without -ffp-contract no product is fused. Sanitizers cannot follow the choice.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define PIPERUN_VECTOR_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define PIPERUN_VECTOR_CLONES
#endif
