// Compiled for any processor, so that it can be asked on any.
#pragma once

namespace contactbench::runtime {

// False where the library was built for AVX2 and its companions, and this machine has none.
bool processor_suits(bool needs_avx2) noexcept;

}  // namespace contactbench::runtime
