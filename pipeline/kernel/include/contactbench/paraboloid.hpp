// The iterative rival: Levenberg-Marquardt on a fitted paraboloid, compiled, so that it is not slowed
// by an interpreter.
//
// In a frame on the fitted face the surface is z = s(x, y), quadratic. Unknown: x, y and k' with
//   p x F + k' (-s_x, -s_y, 1) = M.
// Its weakness is the surface, not the speed: nothing keeps the point on the part that was fitted.
//
// Contract: wrench and result in S, SI. A handful of 3x3 solves; no allocation.
#pragma once

#include "answer.hpp"

namespace contactbench {

struct Paraboloid {
    Vec3 origin;                  // S, m
    Vec3 axis[3];                 // unit, right-handed, S; axis[2] outward
    double c[6] = {};             // s = c0 + c1 x + c2 y + c3 x^2 + c4 x y + c5 y^2
    double reach = 0.1;           // m: a point further from the origin is a failure
};

namespace detail {

struct ParaboloidState {
    double x = 0.0, y = 0.0, k = 0.0;
};

inline double paraboloid_residual(const Paraboloid& s, const Vec3& F, const Vec3& M, const ParaboloidState& u,
                                  double r[3], double jac[3][3]) {
    const double* c = s.c;
    const double z = c[0] + c[1] * u.x + c[2] * u.y + c[3] * u.x * u.x + c[4] * u.x * u.y + c[5] * u.y * u.y;
    const double zx = c[1] + 2.0 * c[3] * u.x + c[4] * u.y, zy = c[2] + c[4] * u.x + 2.0 * c[5] * u.y;
    const Vec3 n{-zx, -zy, 1.0};
    const Vec3 value = cross({u.x, u.y, z}, F) + u.k * n - M;
    const Vec3 columns[3] = {cross({1.0, 0.0, zx}, F) + u.k * Vec3{-2.0 * c[3], -c[4], 0.0},
                             cross({0.0, 1.0, zy}, F) + u.k * Vec3{-c[4], -2.0 * c[5], 0.0}, n};
    r[0] = value.x, r[1] = value.y, r[2] = value.z;
    for (int i = 0; i < 3; ++i)
        jac[0][i] = columns[i].x, jac[1][i] = columns[i].y, jac[2][i] = columns[i].z;
    return norm2(value);
}

// (J^T J + lambda diag(J^T J)) step = -J^T r, by Cramer's rule; false when singular.
inline bool damped_step(const double jac[3][3], const double r[3], double lambda, double step[3]) {
    double a[3][3], b[3];
    for (int i = 0; i < 3; ++i) {
        b[i] = -(jac[0][i] * r[0] + jac[1][i] * r[1] + jac[2][i] * r[2]);
        for (int j = 0; j < 3; ++j)
            a[i][j] = jac[0][i] * jac[0][j] + jac[1][i] * jac[1][j] + jac[2][i] * jac[2][j];
        a[i][i] *= 1.0 + lambda;
    }
    const Vec3 p{a[0][0], a[1][0], a[2][0]}, q{a[0][1], a[1][1], a[2][1]}, s{a[0][2], a[1][2], a[2][2]};
    const Vec3 rhs{b[0], b[1], b[2]};
    const double det = dot(p, cross(q, s));
    if (!(std::fabs(det) > 0.0)) return false;
    step[0] = dot(rhs, cross(q, s)) / det;
    step[1] = dot(p, cross(rhs, s)) / det;
    step[2] = dot(p, cross(q, rhs)) / det;
    return std::isfinite(step[0]) && std::isfinite(step[1]) && std::isfinite(step[2]);
}

}  // namespace detail

// False when it does not converge within 50 iterations, runs off, or ends on a pulling contact.
inline bool locate_iteratively(const Paraboloid& s, const Wrench& w, Candidate& out) {
    const auto local = [&](Vec3 v) { return Vec3{dot(s.axis[0], v), dot(s.axis[1], v), dot(s.axis[2], v)}; };
    const Vec3 F = local(w.F), M = local(w.M - cross(s.origin, w.F));
    detail::ParaboloidState u;
    double r[3], jac[3][3], lambda = 1e-3;
    double cost = detail::paraboloid_residual(s, F, M, u, r, jac);
    bool converged = false;
    for (int i = 0; i < 50 && !converged; ++i) {
        double step[3];
        if (!detail::damped_step(jac, r, lambda, step)) return false;
        const detail::ParaboloidState next{u.x + step[0], u.y + step[1], u.k + step[2]};
        double r_next[3], jac_next[3][3];
        const double cost_next = detail::paraboloid_residual(s, F, M, next, r_next, jac_next);
        if (!(cost_next <= cost)) {
            lambda *= 10.0;
            converged = lambda > 1e12;
            continue;
        }
        u = next;
        cost = cost_next;
        std::copy(r_next, r_next + 3, r);
        std::copy(&jac_next[0][0], &jac_next[0][0] + 9, &jac[0][0]);
        lambda *= 0.1;
        converged = std::fabs(step[0]) + std::fabs(step[1]) < 1e-10;
    }
    if (!converged || !(std::hypot(u.x, u.y) <= s.reach)) return false;
    const double* c = s.c;
    const double z = c[0] + c[1] * u.x + c[2] * u.y + c[3] * u.x * u.x + c[4] * u.x * u.y + c[5] * u.y * u.y;
    const double zx = c[1] + 2.0 * c[3] * u.x + c[4] * u.y, zy = c[2] + c[4] * u.x + 2.0 * c[5] * u.y;
    const double size = std::sqrt(zx * zx + zy * zy + 1.0);
    out = Candidate{};
    out.point = s.origin + (u.x * s.axis[0] + u.y * s.axis[1] + z * s.axis[2]);
    out.normal = (1.0 / size) * (-zx * s.axis[0] - zy * s.axis[1] + s.axis[2]);
    out.torque = u.k * size;
    out.cosine = -dot(out.normal, w.F) / norm(w.F);
    return out.cosine > 0.0;
}

}  // namespace contactbench
