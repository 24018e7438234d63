#include "processor.hpp"

namespace contactbench::runtime {

bool processor_suits([[maybe_unused]] bool needs_avx2) noexcept {
#if defined(__x86_64__)
    __builtin_cpu_init();
    return !needs_avx2 || (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                           __builtin_cpu_supports("bmi2"));
#else
    return true;
#endif
}

}  // namespace contactbench::runtime
