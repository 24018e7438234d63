// Algorithm 1 of Cao, Chen, Hu and Liu (2023), taken literally, to be measured against.
//
// For each plane in turn, priority planes first: solve the 4x4 system of Eq. 6 for (x, y, z, k) and
// accept the first whose point lies on its triangle with F . N <= 0. Nothing is precomputed beyond the
// plane equations, and no candidate after the first is looked at.
//
// Contract: S frame, SI. O(n) with one Gaussian elimination a plane; no allocation after construction.
#pragma once

#include <algorithm>
#include <vector>

#include "answer.hpp"

namespace contactbench {

class PlaneLoop {
public:
    explicit PlaneLoop(const Model& model) {
        const std::size_t n = model.normals.size();
        std::vector<std::int32_t> order(n);
        for (std::size_t f = 0; f < n; ++f) order[f] = std::int32_t(f);
        const auto rank = [&](std::int32_t f) {
            const std::int32_t r = model.region(f);
            return r > 0 ? r : std::numeric_limits<std::int32_t>::max();
        };
        std::stable_sort(order.begin(), order.end(),
                         [&](std::int32_t a, std::int32_t b) { return rank(a) < rank(b); });
        for (std::int32_t f : order) {
            const Triangle& t = model.faces[std::size_t(f)];
            Plane p;
            for (std::size_t c = 0; c < 3; ++c) p.corner[c] = model.vertices[std::size_t(t[c])];
            p.normal = model.normals[std::size_t(f)];
            p.offset = -dot(p.normal, p.corner[0]);
            p.face = f;
            p.region = model.region(f);
            planes_.push_back(p);
        }
    }

    // True when a plane accepts the wrench; `out` is the first that does.
    bool locate(const Wrench& w, Candidate& out) const {
        for (const Plane& p : planes_) {
            double x[4];
            if (!solve_plane(w, p, x)) continue;
            const Vec3 point{x[0], x[1], x[2]};
            if (!(dot(w.F, p.normal) <= 0.0) || !inside(p, point)) continue;
            out = Candidate{};
            out.point = point;
            out.normal = p.normal;
            // Eq. 4 and Eq. 6 print k with different signs; as in Eq. 6, p x F + k n = M.
            out.torque = x[3];
            out.cosine = -dot(w.F, p.normal) / norm(w.F);
            out.face = p.face;
            out.region = p.region;
            return true;
        }
        return false;
    }

private:
    struct Plane {
        Vec3 corner[3], normal;
        double offset = 0.0;
        std::int32_t face = -1, region = 0;
    };

    // Eq. 6 by Gaussian elimination with partial pivoting; false when singular.
    static bool solve_plane(const Wrench& w, const Plane& p, double x[4]) {
        const Vec3 &f = w.F, &n = p.normal;
        double a[4][5] = {{0.0, f.z, -f.y, n.x, w.M.x},
                          {-f.z, 0.0, f.x, n.y, w.M.y},
                          {f.y, -f.x, 0.0, n.z, w.M.z},
                          {n.x, n.y, n.z, 0.0, -p.offset}};
        for (int c = 0; c < 4; ++c) {
            int pivot = c;
            for (int r = c + 1; r < 4; ++r)
                if (std::fabs(a[r][c]) > std::fabs(a[pivot][c])) pivot = r;
            if (a[pivot][c] == 0.0) return false;
            for (int i = c; i < 5; ++i) std::swap(a[c][i], a[pivot][i]);
            for (int r = c + 1; r < 4; ++r) {
                const double factor = a[r][c] / a[c][c];
                for (int i = c; i < 5; ++i) a[r][i] -= factor * a[c][i];
            }
        }
        for (int r = 3; r >= 0; --r) {
            x[r] = a[r][4];
            for (int i = r + 1; i < 4; ++i) x[r] -= a[r][i] * x[i];
            x[r] /= a[r][r];
        }
        return std::isfinite(x[0]) && std::isfinite(x[1]) && std::isfinite(x[2]) && std::isfinite(x[3]);
    }

    // The point and each corner on the same side of the line through the other two.
    static bool inside(const Plane& p, Vec3 point) {
        for (int c = 0; c < 3; ++c) {
            const Vec3 &a = p.corner[c], &b = p.corner[(c + 1) % 3], &apex = p.corner[(c + 2) % 3];
            const Vec3 side = cross(b - a, point - a), inner = cross(b - a, apex - a);
            if (dot(side, inner) < 0.0) return false;
        }
        return true;
    }

    std::vector<Plane> planes_;
};

}  // namespace contactbench
