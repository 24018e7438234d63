// Where on a triangle mesh is nearest to a point, what a ray meets first, and which facets are near each other.
//
// Contract: the mesh is copied; coordinates are finite, in any unit, indices in range (the binding checks).
// Facets need not be closed, oriented or free of degenerate ones. Queries are const, allocate nothing, and
// may run in many threads. Of facets at the same distance the lowest number answers, so the answer does
// not depend on the order of the queries.
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "vec.hpp"

namespace contactbench {

struct Nearest {
    double distance2 = std::numeric_limits<double>::infinity();
    std::int32_t face = -1;
    Vec3 point;
};

struct RayHit {
    double t = std::numeric_limits<double>::infinity();
    std::int32_t face = -1;
};

// The nearest point of the triangle a, b, c: by the region of the plane that p projects to (Ericson,
// Real-Time Collision Detection, 5.1.5). A triangle without area falls through to one of its edges.
inline Vec3 nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 ab = b - a, ac = c - a, ap = p - a;
    const double d1 = dot(ab, ap), d2 = dot(ac, ap);
    if (d1 <= 0.0 && d2 <= 0.0) return a;
    const Vec3 bp = p - b;
    const double d3 = dot(ab, bp), d4 = dot(ac, bp);
    if (d3 >= 0.0 && d4 <= d3) return b;
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return a + (d1 / std::max(d1 - d3, 1e-300)) * ab;
    const Vec3 cp = p - c;
    const double d5 = dot(ab, cp), d6 = dot(ac, cp);
    if (d6 >= 0.0 && d5 <= d6) return c;
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return a + (d2 / std::max(d2 - d6, 1e-300)) * ac;
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0)
        return b + ((d4 - d3) / std::max((d4 - d3) + (d5 - d6), 1e-300)) * (c - b);
    const double whole = 1.0 / (va + vb + vc);
    return a + (vb * whole) * ab + (vc * whole) * ac;
}

class Surface {
public:
    Surface(std::vector<Vec3> vertices, std::vector<std::array<std::int32_t, 3>> faces) {
        const std::size_t n = faces.size();
        std::vector<Vec3> centroid(n);
        for (std::size_t f = 0; f < n; ++f) {
            const auto [a, b, c] = faces[f];
            centroid[f] = (1.0 / 3.0) * (vertices[std::size_t(a)] + vertices[std::size_t(b)] + vertices[std::size_t(c)]);
        }
        face_.resize(n);
        std::iota(face_.begin(), face_.end(), 0);
        nodes_.reserve(2 * (n / (leaf_size / 2) + 1));
        nodes_.emplace_back();
        split(0, 0, n, centroid);
        corners_.resize(n);
        place_.resize(n);
        for (std::size_t i = 0; i < n; ++i) {
            const auto& t = faces[std::size_t(face_[i])];
            for (std::size_t k = 0; k < 3; ++k) corners_[i][k] = vertices[std::size_t(t[k])];
            place_[std::size_t(face_[i])] = std::int32_t(i);
        }
        for (std::size_t i = nodes_.size(); i-- > 0;) bound(nodes_[i]);  // children come after their parent
    }

    std::size_t size() const { return face_.size(); }

    // `guess`: a facet that may be near, -1 for none; it changes the time only.
    Nearest nearest(const Vec3& p, std::int32_t guess = -1) const {
        Nearest best;
        if (guess >= 0) consider(std::size_t(place_[std::size_t(guess)]), p, best);
        std::array<std::pair<double, std::int32_t>, stack_size> stack;  // further children, to be looked at later
        std::size_t top = 0;
        for (const Node* node = &nodes_[0];;) {
            while (node->count == 0) {
                const Node* const children = &nodes_[std::size_t(node->first)];
                const double left = box_distance2(children[0], p), right = box_distance2(children[1], p);
                const bool second = !(left < right);
                const double further = second ? left : right;
                stack[top] = {further, node->first + !second};
                top += further <= best.distance2;
                node = children + second;
            }
            for (std::int32_t i = 0; i < node->count; ++i) consider(std::size_t(node->first + i), p, best);
            do {
                if (top == 0) return best;
                node = &nodes_[std::size_t(stack[--top].second)];
            } while (stack[top].first > best.distance2);
        }
    }

    // What the half-line o + t d, t > 0, meets first; with `any`, whatever it meets.
    RayHit cast(const Vec3& o, const Vec3& d, bool any) const {
        RayHit best;
        const Vec3 inverse{1.0 / d.x, 1.0 / d.y, 1.0 / d.z};
        std::array<std::int32_t, stack_size> stack;
        std::size_t top = 0;
        stack[top++] = 0;
        while (top > 0) {
            const Node& node = nodes_[std::size_t(stack[--top])];
            if (!meets(node, o, inverse, best.t)) continue;
            if (node.count == 0) {
                stack[top++] = node.first;
                stack[top++] = node.first + 1;
                continue;
            }
            for (std::int32_t i = 0; i < node.count; ++i) {
                const std::size_t slot = std::size_t(node.first + i);
                const double t = meets(corners_[slot], o, d);
                if (t < best.t || (t == best.t && face_[slot] < best.face)) best = {t, face_[slot]};
                if (any && best.face >= 0) return best;
            }
        }
        return best;
    }

    struct Alignment {
        double cosine = -1.0;
        std::int32_t face = -1;
    };

    // The facet within `radius` of p whose `normal(facet)` has the largest dot product with `direction`; once that is
    // `enough`, no further ones are looked at.
    template <class Normal>
    Alignment best_aligned(const Vec3& p, const Vec3& direction, double radius, const Normal& normal, double enough) const {
        const double radius2 = radius * radius;
        Alignment best;
        std::array<std::int32_t, stack_size> stack;
        std::size_t top = 0;
        stack[top++] = 0;
        while (top > 0 && best.cosine < enough) {
            const Node& node = nodes_[std::size_t(stack[--top])];
            if (box_distance2(node, p) > radius2) continue;
            if (node.count == 0) {
                stack[top++] = node.first;
                stack[top++] = node.first + 1;
            }
            for (std::int32_t i = 0; i < node.count; ++i) {
                const std::int32_t face = face_[std::size_t(node.first + i)];
                const double cosine = dot(normal(face), direction);
                if (best.face >= 0 && cosine <= best.cosine) continue;
                const auto& t = corners_[std::size_t(node.first + i)];
                if (norm2(p - nearest_on_triangle(p, t[0], t[1], t[2])) <= radius2) best = {cosine, face};
            }
        }
        return best;
    }

    // Calls visit(f, g), f < g, for every two facets whose boxes meet, once and in no order that means anything,
    // until it answers false.
    template <class Visit>
    void each_close_pair(const Visit& visit) const {
        std::vector<Node> box(size());
        for (std::size_t i = 0; i < size(); ++i) {
            box[i].first = std::int32_t(i), box[i].count = 1;
            bound(box[i]);
        }
        const auto see = [&](std::int32_t i, std::int32_t j) {
            if (!meets(box[std::size_t(i)], box[std::size_t(j)])) return true;
            const auto [low, high] = std::minmax(face_[std::size_t(i)], face_[std::size_t(j)]);
            return visit(low, high);
        };
        std::vector<std::pair<std::int32_t, std::int32_t>> stack{{0, 0}};
        while (!stack.empty()) {
            const auto [i, j] = stack.back();
            stack.pop_back();
            const Node &a = nodes_[std::size_t(i)], &b = nodes_[std::size_t(j)];
            if (!meets(a, b)) continue;
            if (a.count > 0 && b.count > 0) {
                for (std::int32_t s = a.first; s < a.first + a.count; ++s)
                    for (std::int32_t t = i == j ? s + 1 : b.first; t < b.first + b.count; ++t)
                        if (!see(s, t)) return;
            } else if (i == j) {
                for (std::int32_t k : {0, 1}) stack.emplace_back(a.first + k, a.first + k);
                stack.emplace_back(a.first, a.first + 1);
            } else {
                // The larger one is opened, so that boxes of like size are compared.
                const bool first = b.count > 0 || (a.count == 0 && norm2(a.high - a.low) >= norm2(b.high - b.low));
                for (std::int32_t k : {0, 1}) stack.push_back(first ? std::pair{a.first + k, j} : std::pair{i, b.first + k});
            }
        }
    }

private:
    static constexpr std::size_t leaf_size = 4;
    // Halving 2^31 facets down to leaves takes under 32 levels, and each leaves at most one node waiting.
    static constexpr std::size_t stack_size = 64;

    struct Node {
        Vec3 low, high;
        std::int32_t first = 0;  // of a leaf its first slot, otherwise its left child; the right one follows
        std::int32_t count = 0;  // of a leaf its facets, otherwise 0
    };

    void split(std::size_t node, std::size_t lo, std::size_t hi, const std::vector<Vec3>& centroid) {
        if (hi - lo <= leaf_size) {
            nodes_[node].first = std::int32_t(lo);
            nodes_[node].count = std::int32_t(hi - lo);
            return;
        }
        Vec3 least = centroid[std::size_t(face_[lo])], most = least;
        for (std::size_t i = lo; i < hi; ++i) {
            const Vec3& c = centroid[std::size_t(face_[i])];
            least = {std::min(least.x, c.x), std::min(least.y, c.y), std::min(least.z, c.z)};
            most = {std::max(most.x, c.x), std::max(most.y, c.y), std::max(most.z, c.z)};
        }
        const Vec3 d = most - least;
        double Vec3::*axis = d.x >= d.y && d.x >= d.z ? &Vec3::x : d.y >= d.z ? &Vec3::y : &Vec3::z;
        const std::size_t mid = lo + (hi - lo) / 2;
        const auto at = [&](std::size_t i) { return face_.begin() + std::ptrdiff_t(i); };
        std::nth_element(at(lo), at(mid), at(hi), [&](std::int32_t a, std::int32_t b) {
            const double p = centroid[std::size_t(a)].*axis, q = centroid[std::size_t(b)].*axis;
            return p != q ? p < q : a < b;
        });
        const std::size_t left = nodes_.size();
        nodes_.emplace_back();
        nodes_.emplace_back();
        nodes_[node].first = std::int32_t(left);
        split(left, lo, mid, centroid);
        split(left + 1, mid, hi, centroid);
    }

    void bound(Node& node) const {
        constexpr double inf = std::numeric_limits<double>::infinity();
        node.low = {inf, inf, inf}, node.high = {-inf, -inf, -inf};
        const auto include = [&](const Vec3& low, const Vec3& high) {
            node.low = {std::min(node.low.x, low.x), std::min(node.low.y, low.y), std::min(node.low.z, low.z)};
            node.high = {std::max(node.high.x, high.x), std::max(node.high.y, high.y), std::max(node.high.z, high.z)};
        };
        for (std::int32_t i = 0; i < node.count; ++i)
            for (const Vec3& p : corners_[std::size_t(node.first + i)]) include(p, p);
        for (std::size_t k = 0; node.count == 0 && k < 2; ++k) {
            const Node& child = nodes_[std::size_t(node.first) + k];
            include(child.low, child.high);
        }
    }

    static bool meets(const Node& a, const Node& b) {
        return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y &&
               a.low.z <= b.high.z && b.low.z <= a.high.z;
    }

    static double box_distance2(const Node& node, const Vec3& p) {
        // Not the largest of a list, for which compilers make branches.
        const auto outside = [](double low, double at, double high) { return std::max(std::max(low - at, at - high), 0.0); };
        const Vec3 d{outside(node.low.x, p.x, node.high.x), outside(node.low.y, p.y, node.high.y),
                     outside(node.low.z, p.z, node.high.z)};
        // The nearest point of a facet is rounded, and may come out a little nearer than its own box.
        return norm2(d) * (1.0 - 1e-12);
    }

    void consider(std::size_t slot, const Vec3& p, Nearest& best) const {
        const auto& t = corners_[slot];
        const Vec3 q = nearest_on_triangle(p, t[0], t[1], t[2]);
        const double d2 = norm2(p - q);
        if (d2 < best.distance2 || (d2 == best.distance2 && face_[slot] < best.face)) best = {d2, face_[slot], q};
    }

    static bool meets(const Node& node, const Vec3& o, const Vec3& inverse, double longest) {
        double near = 0.0, far = longest;
        const auto slab = [&](double low, double high, double from, double inv) {
            // A ray along the slab is in it for good or never; 0 * inf would be NaN at its very side.
            if (std::isinf(inv)) {
                if (from < low || from > high) far = -1.0;
                return;
            }
            const double a = (low - from) * inv, b = (high - from) * inv;
            near = std::max(near, std::min(a, b));
            far = std::min(far, std::max(a, b));
        };
        slab(node.low.x, node.high.x, o.x, inverse.x);
        slab(node.low.y, node.high.y, o.y, inverse.y);
        slab(node.low.z, node.high.z, o.z, inverse.z);
        return near <= far * (1.0 + 1e-12);
    }

    // The signed volumes of the ray's line with the edges: on a shared edge both facets see the same
    // numbers, so no ray slips through between them.
    static double meets(const std::array<Vec3, 3>& t, const Vec3& o, const Vec3& d) {
        constexpr double none = std::numeric_limits<double>::infinity();
        const Vec3 a = t[0] - o, b = t[1] - o, c = t[2] - o;
        const double u = dot(d, cross(c, b)), v = dot(d, cross(a, c)), w = dot(d, cross(b, a));
        if ((u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0)) return none;
        const double sum = u + v + w;
        if (sum == 0.0) return none;
        const double along = (u * dot(a, d) + v * dot(b, d) + w * dot(c, d)) / (sum * norm2(d));
        return along > 0.0 ? along : none;
    }

    std::vector<Node> nodes_;
    std::vector<std::array<Vec3, 3>> corners_;  // by slot: the facets of a leaf lie together
    std::vector<std::int32_t> face_;            // slot -> facet
    std::vector<std::int32_t> place_;           // facet -> slot
};

}  // namespace contactbench
