// Three-vectors and the few operations that contact sensing needs.
//
// Contract: plain values, double precision, no units of their own. Nothing here allocates or throws.
// Every operation is a fixed sequence of IEEE operations; compiled with -ffp-contract=off it gives the
// same bits on every processor, which the tests of the pruned search against the exhaustive one rely on.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

// Every answer is the same to the bit on every machine, and NaN stands for what there is none of.
#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || __FINITE_MATH_ONLY__ + 0
#error "contactbench needs IEEE arithmetic: compile it without -ffast-math, -Ofast and the options that these imply"
#endif

namespace contactbench {

struct Vec3 {
    double x = 0.0, y = 0.0, z = 0.0;
};

inline Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
inline Vec3 operator*(double s, Vec3 a) { return {s * a.x, s * a.y, s * a.z}; }
inline double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 cross(Vec3 a, Vec3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double norm2(Vec3 a) { return dot(a, a); }
inline double norm(Vec3 a) { return std::sqrt(norm2(a)); }
inline bool finite(Vec3 a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }

// A force and a torque about the sensor origin, both in S, N and N*m: what acts on the probe.
struct Wrench {
    Vec3 F, M;
};

// Symmetric or not, row major.
struct Mat3 {
    double m[3][3] = {};
};

// Of a symmetric matrix without negative ones, by Jacobi's rotations.
inline double largest_eigenvalue(Mat3 a) {
    constexpr double small = 1e-16;
    for (int sweep = 0; sweep < 20; ++sweep)
        for (const auto [p, q, r] : {std::array<int, 3>{0, 1, 2}, {0, 2, 1}, {1, 2, 0}}) {
            auto& m = a.m;
            const double pq = m[p][q], pr = m[p][r], qr = m[q][r];
            if (!(std::fabs(pq) > small * (m[p][p] + m[q][q]))) continue;
            const double half = 0.5 * (m[q][q] - m[p][p]) / pq;
            const double t = std::copysign(1.0, half) / (std::fabs(half) + std::sqrt(half * half + 1.0));
            const double c = 1.0 / std::sqrt(t * t + 1.0), s = t * c;
            m[p][p] -= t * pq, m[q][q] += t * pq;
            m[p][q] = m[q][p] = 0.0;
            m[p][r] = m[r][p] = c * pr - s * qr;
            m[q][r] = m[r][q] = s * pr + c * qr;
        }
    return std::max({a.m[0][0], a.m[1][1], a.m[2][2], 0.0});
}

}  // namespace contactbench
