// The caller's floating-point environment, put aside for a call.
#pragma once

#if defined(__SSE2__)
#include <xmmintrin.h>
#else
#include <cfenv>
#endif

namespace contactbench::runtime {

// Traps would end the process, and rounding or flushing of small numbers change answers. While it lives arithmetic is as
// in a new process; then everything is as it was, the raised flags too. Where SSE computes,
// its register alone is changed: the old unit, which nothing uses, costs a tenth of a touch.
class Environment {
public:
    Environment() noexcept {
#if defined(__SSE2__)
        kept_ = _mm_getcsr();
        _mm_setcsr(0x1F80);
#else
        std::fegetenv(&kept_);
        std::fesetenv(FE_DFL_ENV);
#endif
        settle();
    }
    ~Environment() {
        settle();
#if defined(__SSE2__)
        _mm_setcsr(kept_);
#else
        std::fesetenv(&kept_);
#endif
    }
    Environment(const Environment&) = delete;
    Environment& operator=(const Environment&) = delete;

private:
    // No read or write moves past it, and so no arithmetic on what was read.
    static void settle() noexcept { asm volatile("" ::: "memory"); }

#if defined(__SSE2__)
    unsigned kept_;
#else
    std::fenv_t kept_;
#endif
};

}  // namespace contactbench::runtime
