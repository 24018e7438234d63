// The caller's floating-point environment, put aside for a call.
#pragma once

#include <cfenv>

namespace contactbench::runtime {

// Traps would end the process, and rounding or flushing of small numbers change answers. While it lives arithmetic is as
// in a new process; then everything is as it was, the raised flags too.
class Environment {
public:
    Environment() noexcept {
        std::fegetenv(&kept_);
        std::fesetenv(FE_DFL_ENV);
        settle();
    }
    ~Environment() {
        settle();
        std::fesetenv(&kept_);
    }
    Environment(const Environment&) = delete;
    Environment& operator=(const Environment&) = delete;

private:
    // No read or write moves past it, and so no arithmetic on what was read.
    static void settle() noexcept { asm volatile("" ::: "memory"); }

    std::fenv_t kept_;
};

}  // namespace contactbench::runtime
