// Eight numbers at once, spelled with the vector extension of GCC and Clang.
//
// Contract: every lane gets the same IEEE operations as scalar code would, so results do not depend on
// the instruction set; only the sign masks need a processor's own spelling. Left to
// the auto-vectoriser the same loops were unrolled to scalar code (3x slower).
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>
#if defined(__AVX__)
#include <immintrin.h>
#endif

namespace contactbench {

inline constexpr int lanes = 8;

typedef float Float8 __attribute__((vector_size(32)));
typedef double Double4 __attribute__((vector_size(32)));
typedef std::int64_t Int4 __attribute__((vector_size(32)));

#define CONTACTBENCH_INLINE inline __attribute__((always_inline))

typedef std::int32_t Int8 __attribute__((vector_size(32)));

// Small whole numbers, widened.
template <class T>
CONTACTBENCH_INLINE Float8 load8_whole(const T* p) {
#if defined(__AVX2__)
    if constexpr (sizeof(T) == 1) {
        const __m128i raw = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(p));
        return Float8(_mm256_cvtepi32_ps(std::is_signed_v<T> ? _mm256_cvtepi8_epi32(raw) : _mm256_cvtepu8_epi32(raw)));
    } else {
        const __m128i raw = _mm_loadu_si128(reinterpret_cast<const __m128i*>(p));
        return Float8(_mm256_cvtepi32_ps(std::is_signed_v<T> ? _mm256_cvtepi16_epi32(raw) : _mm256_cvtepu16_epi32(raw)));
    }
#else
    typedef T Small __attribute__((vector_size(lanes * sizeof(T))));
    Small raw;
    std::memcpy(&raw, p, sizeof raw);
    return __builtin_convertvector(__builtin_convertvector(raw, Int8), Float8);
#endif
}

CONTACTBENCH_INLINE Float8 load8(const float* p) {  // aligned to a float alone
    Float8 out;
    std::memcpy(&out, p, sizeof out);
    return out;
}
// From an array aligned to 32 bytes.
CONTACTBENCH_INLINE Double4 load4(const double* p) { return *reinterpret_cast<const Double4*>(p); }

// Spelled out where GCC would take two instructions for one.
#if defined(__AVX__)
CONTACTBENCH_INLINE Float8 larger(Float8 a, Float8 b) { return Float8(_mm256_max_ps(__m256(b), __m256(a))); }
CONTACTBENCH_INLINE Float8 smaller(Float8 a, Float8 b) { return Float8(_mm256_min_ps(__m256(b), __m256(a))); }
CONTACTBENCH_INLINE Float8 magnitude(Float8 a) {
    return Float8(_mm256_andnot_ps(_mm256_set1_ps(-0.0f), __m256(a)));
}
CONTACTBENCH_INLINE Float8 root(Float8 a) { return Float8(_mm256_sqrt_ps(__m256(a))); }
CONTACTBENCH_INLINE Float8 select(Int8 which, Float8 a, Float8 b) { return which ? a : b; }
CONTACTBENCH_INLINE float least_of(Float8 a) {
    const __m128 four = _mm_min_ps(_mm256_castps256_ps128(__m256(a)), _mm256_extractf128_ps(__m256(a), 1));
    const __m128 two = _mm_min_ps(four, _mm_movehl_ps(four, four));
    return _mm_cvtss_f32(_mm_min_ss(two, _mm_movehdup_ps(two)));
}
#else
// Half by half: GCC compares lane by lane what a processor has no register for.
typedef float Float4 __attribute__((vector_size(16)));
struct Halves {
    Float4 low, high;
};
CONTACTBENCH_INLINE Float8 larger(Float8 a, Float8 b) {
    const Halves x = std::bit_cast<Halves>(a), y = std::bit_cast<Halves>(b);
    return std::bit_cast<Float8>(Halves{x.low < y.low ? y.low : x.low, x.high < y.high ? y.high : x.high});
}
CONTACTBENCH_INLINE Float8 smaller(Float8 a, Float8 b) {
    const Halves x = std::bit_cast<Halves>(a), y = std::bit_cast<Halves>(b);
    return std::bit_cast<Float8>(Halves{y.low < x.low ? y.low : x.low, y.high < x.high ? y.high : x.high});
}
CONTACTBENCH_INLINE Float8 magnitude(Float8 a) { return Float8(Int8(a) & 0x7fffffff); }
CONTACTBENCH_INLINE Float8 root(Float8 a) {
    Float8 out{};
    for (int l = 0; l < lanes; ++l) out[l] = std::sqrt(a[l]);
    return out;
}
CONTACTBENCH_INLINE Float8 select(Int8 which, Float8 a, Float8 b) {
    return Float8((which & Int8(a)) | (~which & Int8(b)));
}
CONTACTBENCH_INLINE float least_of(Float8 a) {
    float least = a[0];
    for (int l = 1; l < lanes; ++l) least = a[l] < least ? a[l] : least;
    return least;
}
#endif

// Bit l is set when lane l is true.
CONTACTBENCH_INLINE unsigned mask_of(Int8 a) {
#if defined(__AVX__)
    return unsigned(_mm256_movemask_ps(__m256(a)));
#else
    unsigned mask = 0;
    for (int l = 0; l < lanes; ++l) mask |= unsigned(a[l] & 1) << l;
    return mask;
#endif
}

inline constexpr Int8 lane_numbers = {0, 1, 2, 3, 4, 5, 6, 7};

// True in the lanes whose bit is set.
CONTACTBENCH_INLINE Int8 lanes_of(unsigned bits) { return ((Int8{} + int(bits)) >> lane_numbers & 1) != 0; }

// The same names for one number, so that a formula is written once.
CONTACTBENCH_INLINE double larger(double a, double b) { return a < b ? b : a; }
CONTACTBENCH_INLINE double smaller(double a, double b) { return b < a ? b : a; }
CONTACTBENCH_INLINE double magnitude(double a) { return std::fabs(a); }
CONTACTBENCH_INLINE double root(double a) { return std::sqrt(a); }
CONTACTBENCH_INLINE double select(bool which, double a, double b) { return which ? a : b; }

template <class R>
struct Scalar {
    using type = double;
};
template <>
struct Scalar<Float8> {
    using type = float;
};

// Bit l is set when lane l is all ones, as a comparison leaves it.
CONTACTBENCH_INLINE unsigned truth_mask(Int4 a) {
#if defined(__AVX__)
    return unsigned(_mm256_movemask_pd(__m256d(a)));
#else
    unsigned mask = 0;
    for (int l = 0; l < 4; ++l) mask |= unsigned(a[l] & 1) << l;
    return mask;
#endif
}

}  // namespace contactbench
