// Tests of the headers alone, with nothing but a compiler: see packaging/sanitize.
#include <cstdlib>
#include <new>

#include "facet_checks.hpp"
#include "geodesic_checks.hpp"
#include "search_checks.hpp"
#include "solver_checks.hpp"
#include "stream_checks.hpp"
#include "table_checks.hpp"
#ifndef CHECKS
#include "fuzz_kernel.cpp"
#endif

namespace {
long allocation_count = 0;

void* allocate(std::size_t size, std::size_t alignment = 0) {
    ++allocation_count;
    // Exactly the size asked for, so that the address sanitizer sees the first byte beyond.
    void* p = nullptr;
    if (alignment == 0) p = std::malloc(size > 0 ? size : 1);
    else if (posix_memalign(&p, alignment, size) != 0) p = nullptr;
    if (!p) std::abort();
    return p;
}
}  // namespace

// Every form that the standard library and the headers use, so that no allocation goes uncounted.
__attribute__((noinline)) void* operator new(std::size_t size) { return allocate(size); }
__attribute__((noinline)) void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return allocate(size); }
__attribute__((noinline)) void* operator new(std::size_t size, std::align_val_t alignment) { return allocate(size, std::size_t(alignment)); }
__attribute__((noinline)) void operator delete(void* p) noexcept { std::free(p); }
__attribute__((noinline)) void operator delete(void* p, const std::nothrow_t&) noexcept { std::free(p); }
__attribute__((noinline)) void operator delete(void* p, std::size_t) noexcept { std::free(p); }
__attribute__((noinline)) void operator delete(void* p, std::align_val_t) noexcept { std::free(p); }
__attribute__((noinline)) void operator delete(void* p, std::size_t, std::align_val_t) noexcept { std::free(p); }

long testing::allocations() { return allocation_count; }

// With --first it stops at the first check that fails. packaging/mutants compiles with CHECKS, the only ones that run.
int main(int argc, char** argv) {
    testing::Counts& counts = testing::counts();
    counts.stop = argc > 1 && std::strcmp(argv[1], "--first") == 0;
#ifdef CHECKS
    testing::CHECKS();
#else
    if (argc > 1 && std::strcmp(argv[1], "--fuzz") == 0) return fuzz(argc, argv);
    testing::check_facets();
    testing::check_search();
    testing::check_solver();
    testing::check_geodesic();
    testing::check_streams();
    testing::check_decimals();
    testing::check_rows();
#endif
    if (counts.failed > 0) std::printf("%ld checks failed, ", counts.failed);
    std::printf("%ld checks passed\n", counts.passed);
    return counts.failed > 0;
}
