// On which side of a plane or line a point is, decided exactly.
//
// A floating-point evaluation with an error bound answers nearly always; where it cannot, the determinant is
// evaluated without rounding, as a sum of doubles that do not overlap (Shewchuk, Adaptive Precision Floating-Point
// Arithmetic and Fast Robust Geometric Predicates, 1997).
//
// Contract: each coordinate is 0 or between 2^-250 and 2^300 in size, so that no product of three over- or
// underflows; `fit_for_exact` makes it so. Nothing here allocates or throws. Needs -ffp-contract=off.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "vec.hpp"

namespace contactbench {

// Whether a coordinate can be computed with exactly; one too small to be (below 1e-75) becomes 0.
inline bool fit_for_exact(double& coordinate) {
    if (std::fabs(coordinate) < 0x1p-250) coordinate = 0.0;
    return std::fabs(coordinate) <= 0x1p300;
}

namespace exact {

// a + b = sum + rest, without error.
inline double two_sum(double a, double b, double& rest) {
    const double sum = a + b, from_b = sum - a, from_a = sum - from_b;
    rest = (a - from_a) + (b - from_b);
    return sum;
}

// a * b = product + rest, without error: both factors are split into halves of 26 bits.
inline double two_product(double a, double b, double& rest) {
    constexpr double splitter = 134217729.0;  // 2^27 + 1
    const double product = a * b;
    const double ca = splitter * a, cb = splitter * b;
    const double a_high = ca - (ca - a), b_high = cb - (cb - b);
    const double a_low = a - a_high, b_low = b - b_high;
    rest = a_low * b_low - (((product - a_high * b_high) - a_low * b_high) - a_high * b_low);
    return product;
}

// A number as a sum of at most N doubles that do not overlap, the smallest first, none of them zero.
template <std::size_t N>
struct Sum {
    std::array<double, N> part;
    std::size_t size = 0;

    void append(double value) {
        if (value != 0.0) part[size++] = value;
    }
    int sign() const { return size == 0 ? 0 : part[size - 1] > 0.0 ? 1 : -1; }
    Sum operator-() const {
        Sum result;
        for (std::size_t i = 0; i < size; ++i) result.append(-part[i]);
        return result;
    }
};

inline Sum<2> difference(double a, double b) {
    double rest;
    const double high = two_sum(a, -b, rest);
    Sum<2> result;
    result.append(rest);
    result.append(high);
    return result;
}

template <std::size_t N, std::size_t M>
Sum<N + M> operator+(const Sum<N>& e, const Sum<M>& f) {
    Sum<N + M> result;
    std::size_t i = 0, j = 0;
    const auto next = [&] {
        return j == f.size || (i < e.size && std::fabs(e.part[i]) < std::fabs(f.part[j])) ? e.part[i++] : f.part[j++];
    };
    if (e.size + f.size == 0) return result;
    double high = next(), rest;
    while (i < e.size || j < f.size) {
        high = two_sum(high, next(), rest);
        result.append(rest);
    }
    result.append(high);
    return result;
}

template <std::size_t N>
Sum<2 * N> operator*(const Sum<N>& e, double factor) {
    Sum<2 * N> result;
    if (e.size == 0) return result;
    double rest;
    double high = two_product(e.part[0], factor, rest);
    result.append(rest);
    for (std::size_t i = 1; i < e.size; ++i) {
        double low;
        const double product = two_product(e.part[i], factor, low);
        const double middle = two_sum(high, low, rest);
        result.append(rest);
        high = two_sum(product, middle, rest);
        result.append(rest);
    }
    result.append(high);
    return result;
}

template <std::size_t N>
Sum<4 * N> operator*(const Sum<N>& e, const Sum<2>& f) {
    const Sum<2 * N> low = f.size == 2 ? e * f.part[0] : Sum<2 * N>{};
    return low + (f.size > 0 ? e * f.part[f.size - 1] : Sum<2 * N>{});
}

// a b - c d
inline Sum<16> minor(const Sum<2>& a, const Sum<2>& b, const Sum<2>& c, const Sum<2>& d) {
    return a * b + -c * d;
}

inline int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const Sum<2> bx = difference(b.x, a.x), by = difference(b.y, a.y), bz = difference(b.z, a.z);
    const Sum<2> cx = difference(c.x, a.x), cy = difference(c.y, a.y), cz = difference(c.z, a.z);
    const Sum<2> dx = difference(d.x, a.x), dy = difference(d.y, a.y), dz = difference(d.z, a.z);
    return ((minor(cy, dz, cz, dy) * bx + minor(cz, dx, cx, dz) * by) + minor(cx, dy, cy, dx) * bz).sign();
}

}  // namespace exact

// The sign of (b - a) x (c - a) . (d - a): 1 where d is on the side that a, b, c are seen counterclockwise from.
inline int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const Vec3 u = b - a, v = c - a, w = d - a;
    const double yz = v.y * w.z, zy = v.z * w.y, zx = v.z * w.x, xz = v.x * w.z, xy = v.x * w.y, yx = v.y * w.x;
    const double volume = u.x * (yz - zy) + u.y * (zx - xz) + u.z * (xy - yx);
    const double size = std::fabs(u.x) * (std::fabs(yz) + std::fabs(zy)) + std::fabs(u.y) * (std::fabs(zx) + std::fabs(xz)) +
                        std::fabs(u.z) * (std::fabs(xy) + std::fabs(yx));
    const double doubt = 0x1p-50 * size;  // 8 roundings of 2^-53
    if (volume > doubt) return 1;
    if (volume < -doubt) return -1;
    return size == 0.0 ? 0 : exact::orientation(a, b, c, d);
}

struct Vec2 {
    double x = 0.0, y = 0.0;
};

// The sign of (b - a) x (c - a): 1 where a, b, c run counterclockwise.
inline int orientation(const Vec2& a, const Vec2& b, const Vec2& c) {
    const double left = (b.x - a.x) * (c.y - a.y), right = (b.y - a.y) * (c.x - a.x);
    const double area = left - right, doubt = 0x1p-51 * (std::fabs(left) + std::fabs(right));
    if (area > doubt) return 1;
    if (area < -doubt) return -1;
    return exact::minor(exact::difference(b.x, a.x), exact::difference(c.y, a.y), exact::difference(b.y, a.y),
                        exact::difference(c.x, a.x)).sign();
}

}  // namespace contactbench
