// Which instruction sets this processor has. Apart, so that asking loads no kernel.
#include <nanobind/nanobind.h>

namespace nb = nanobind;

NB_MODULE(_cpu, m) {
    m.doc() = "Processor features that decide which kernel is loaded.";
    m.def(
        "features",
        [] {
            nb::dict d;
#if defined(__x86_64__)
            __builtin_cpu_init();
            d["avx2"] = bool(__builtin_cpu_supports("x86-64-v3"));
            d["avx512"] = bool(__builtin_cpu_supports("x86-64-v4"));
#endif
            return d;
        },
        "Instruction sets by name, empty where the processor has no choice of kernels.");
}
