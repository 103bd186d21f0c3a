#pragma once

/// Before a function that newer instructions make faster: it is compiled twice, once with the instruction set
/// named ("avx2": registers of 256 bits; "bmi2": products of 64 by 64 bits without moves), and the program
/// picks at its start. The bits are the same: without -ffast-math no sum is reordered, and with
/// -ffp-contract=off no product is fused. Sanitizers cannot follow the choice.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define PIPERUN_CLONE_FOR(instructions) __attribute__((target_clones(instructions, "default")))
#else
#define PIPERUN_CLONE_FOR(instructions)
#endif
