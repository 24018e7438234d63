// Which facets of a mesh share points beyond the vertices and edges that they have in common: decided exactly.
//
// Contract: coordinates as exact.hpp wants them, indices in range. Facets without area (three points on a line, exactly) have
// no inside and are left out. The answer does not depend on how the mesh lies or how facets are numbered or turned.
// O(m log m + pairs of facets whose boxes meet); what is kept is bounded by `limit`.
#pragma once

#include <algorithm>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

#include "exact.hpp"
#include "surface.hpp"

namespace contactbench {

enum class Meeting : std::uint8_t {
    crossing = 0,  // their insides meet in a line, or the surface passes through a facet at an edge of its own
    touching = 1,  // a vertex or edge of one lies on the other: no inside meets an inside
    overlap = 2,   // they lie in one plane and share an area; also folded onto each other at an edge, or the same twice
    none = 3,
};

struct Crossings {
    std::vector<std::int32_t> pairs;    // 2 k: facets, the lower number first, in ascending order
    std::vector<std::uint8_t> kinds;    // k: Meeting
    std::array<std::int64_t, 3> count{};  // of each kind, those that are not listed included
    bool complete = true;               // whether every pair was looked at
};

namespace detail {

using Facet = std::array<std::int32_t, 3>;

// Two facets at a time. Every test that rejects by rounded numbers has an error bound; what it leaves is exact.
class FacetPair {
public:
    FacetPair(const std::vector<Vec3>& vertices, const Facet& first, const Facet& second) : vertices_(vertices), t_{first, second} {
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j)
                if (first[i] == second[j]) common_[0][i] = common_[1][j] = true, ++shared_;
    }

    Meeting meet() {
        if (shared_ >= 2) return shared_ == 3 || folded() ? Meeting::overlap : Meeting::none;
        if (shared_ == 1 ? wedges_apart() : apart()) return Meeting::none;
        for (std::size_t k : {0, 1}) {
            sides(k);
            const int least = std::min({side_[k][0], side_[k][1], side_[k][2]});
            const int most = std::max({side_[k][0], side_[k][1], side_[k][2]});
            if (least > 0 || most < 0) return Meeting::none;
            if (least == 0 && most == 0) return coplanar();
            // The common vertex is on the plane, the other two are on the same side of it.
            if (shared_ == 1 && zeros(k) == 1 && least * most == 0) return Meeting::none;
        }
        return in_space();
    }

    // Where a facet (0 or 1) stands on the other one's inside with an edge: its number and the side that it is on.
    struct Standing {
        int facet = -1;
        std::size_t corner = 0;  // opposite the edge
        int side = 0;
    };
    const Standing& standing() const { return standing_; }

private:
    const Vec3& at(std::size_t k, std::size_t corner) const { return vertices_[std::size_t(t_[k][corner % 3])]; }
    int zeros(std::size_t k) const { return int(std::count(side_[k].begin(), side_[k].end(), 0)); }
    bool straddles(std::size_t k) const {
        return *std::min_element(side_[k].begin(), side_[k].end()) < 0 && *std::max_element(side_[k].begin(), side_[k].end()) > 0;
    }
    Vec3 normal(std::size_t k) const { return cross(at(k, 1) - at(k, 0), at(k, 2) - at(k, 0)); }

    // The sides of the other facet's plane that the corners of facet k are on.
    void sides(std::size_t k) {
        const std::size_t o = 1 - k;
        for (std::size_t i = 0; i < 3; ++i)
            side_[k][i] = common_[k][i] ? 0 : orientation(at(o, 0), at(o, 1), at(o, 2), at(k, i));
    }

    // Dot product of `axis`, any numbers at all, with `v`, a difference of two vertices, and how far it may be off.
    struct Extent {
        double value, doubt;
    };
    static Extent along(const Vec3& axis, const Vec3& v) {
        const double x = axis.x * v.x, y = axis.y * v.y, z = axis.z * v.z;
        return {x + y + z, 0x1p-50 * (std::fabs(x) + std::fabs(y) + std::fabs(z))};
    }

    // Whether the plane across `axis` certainly separates them.
    bool apart_along(const Vec3& axis) const {
        double low[2], high[2], doubt = 0.0;
        for (std::size_t k : {0, 1})
            for (std::size_t i = 0; i < 3; ++i) {
                const Extent e = along(axis, at(k, i) - at(0, 0));
                low[k] = i == 0 ? e.value : std::min(low[k], e.value);
                high[k] = i == 0 ? e.value : std::max(high[k], e.value);
                doubt = std::max(doubt, e.doubt);
            }
        return low[0] - high[1] > 2.0 * doubt || low[1] - high[0] > 2.0 * doubt;
    }

    bool apart() const {
        const Vec3 n[2] = {normal(0), normal(1)};
        if (apart_along(n[0]) || apart_along(n[1])) return true;
        for (std::size_t k : {0, 1})
            for (std::size_t i = 0; i < 3; ++i)
                if (apart_along(cross(n[k], at(k, i + 1) - at(k, i)))) return true;
        return false;
    }

    // Whether a plane through the one common vertex certainly separates the other four.
    bool wedges_apart() const {
        Vec3 leg[2][2], middle[2];
        for (std::size_t k : {0, 1}) {
            const std::size_t c = corner_in_common(k);
            for (std::size_t i : {0, 1}) {
                leg[k][i] = at(k, c + 1 + i) - at(k, c);
                middle[k] = middle[k] + 1.0 / std::max(norm(leg[k][i]), 1e-300) * leg[k][i];
            }
        }
        const Vec3 axis = middle[0] - middle[1];
        for (std::size_t i : {0, 1}) {
            const Extent first = along(axis, leg[0][i]), second = along(axis, leg[1][i]);
            if (first.value <= first.doubt || second.value >= -second.doubt) return false;
        }
        return true;
    }

    std::size_t corner_in_common(std::size_t k) const {
        return std::size_t(std::find(common_[k].begin(), common_[k].end(), true) - common_[k].begin());
    }

    // Facets at one edge meet beyond it only if they lie on the same side of it, in one plane.
    bool folded() const {
        const auto free = [&](std::size_t k) {
            return std::size_t(std::find(common_[k].begin(), common_[k].end(), false) - common_[k].begin());
        };
        const std::size_t i = free(0);
        const Vec3 &a = at(0, i + 1), &b = at(0, i + 2), &c = at(0, i), &d = at(1, free(1));
        const Vec3 edge = b - a, m = cross(edge, c - a), n = cross(edge, d - a);
        const double size = norm2(edge) * norm(c - a) * norm(d - a);
        if (dot(m, n) < -0x1p-47 * size - 1e-300) return false;  // 1e-300: what underflows
        if (orientation(a, b, c, d) != 0) return false;
        const Flat flat(a, b, c);
        return orientation(flat(a), flat(b), flat(d)) == flat.turn;
    }

    // The plane of a facet with an area, seen along an axis that does not lie in it.
    struct Flat {
        Flat(const Vec3& a, const Vec3& b, const Vec3& c) {
            for (axis = 0; axis < 3; ++axis) {
                turn = orientation((*this)(a), (*this)(b), (*this)(c));
                if (turn != 0) return;
            }
        }
        Vec2 operator()(const Vec3& p) const { return axis == 0 ? Vec2{p.y, p.z} : axis == 1 ? Vec2{p.z, p.x} : Vec2{p.x, p.y}; }
        int axis = 0;
        int turn = 0;  // of the facet itself
    };

    Meeting coplanar() const {
        const Flat flat(at(0, 0), at(0, 1), at(0, 2));
        std::array<Vec2, 3> p[2];
        for (std::size_t k : {0, 1}) {
            p[k] = {flat(at(k, 0)), flat(at(k, 1)), flat(at(k, 2))};
            if (orientation(p[k][0], p[k][1], p[k][2]) < 0) std::swap(p[k][1], p[k][2]);
        }
        // Convex polygons are apart if and only if an edge of one of them has all of the other one outside.
        bool share_area = true;
        for (std::size_t k : {0, 1})
            for (std::size_t i = 0; i < 3; ++i) {
                int most = -1;
                for (const Vec2& q : p[1 - k]) most = std::max(most, orientation(p[k][i], p[k][(i + 1) % 3], q));
                if (most < 0) return Meeting::none;
                share_area = share_area && most > 0;
            }
        if (share_area) return Meeting::overlap;
        if (shared_ == 0) return Meeting::touching;
        // Edges that run the same way from the common vertex: the end of the shorter one lies on the other.
        for (std::size_t k : {0, 1})
            for (std::size_t i = 0; i < 3; ++i)
                if (!common_[k][i] && holds(p[1 - k], flat(at(k, i)))) return Meeting::touching;
        return Meeting::none;
    }

    static bool holds(const std::array<Vec2, 3>& triangle, const Vec2& q) {
        for (std::size_t i = 0; i < 3; ++i)
            if (orientation(triangle[i], triangle[(i + 1) % 3], q) < 0) return false;
        return true;
    }

    // The planes meet in a line, each facet has a stretch of it, perhaps only a point: do the stretches meet?
    Meeting in_space() {
        // The corner that is alone on its side of the other plane; the two edges from it end the stretch. The
        // other facet is turned over where needed so that this is the upper side.
        std::size_t lone[2];
        bool turned[2];
        for (std::size_t k : {0, 1}) {
            const auto alone = [&](std::size_t i, int up) {
                const int s = up * side_[k][i], q = up * side_[k][(i + 1) % 3], r = up * side_[k][(i + 2) % 3];
                return (s > 0 && q <= 0 && r <= 0) || (s == 0 && q < 0 && r < 0);
            };
            for (std::size_t i = 0; i < 3; ++i) {
                if (alone(i, 1)) lone[k] = i, turned[1 - k] = false;
                if (alone(i, -1)) lone[k] = i, turned[1 - k] = true;
            }
        }
        const auto corners = [&](std::size_t k) {
            std::array<Vec3, 3> c{at(k, lone[k]), at(k, lone[k] + 1), at(k, lone[k] + 2)};
            if (turned[k]) std::swap(c[1], c[2]);
            return c;
        };
        const auto [p, q, r] = corners(0);
        const auto [u, v, w] = corners(1);
        // Along the cross product of the normals the first stretch runs from edge pr to pq, the second from uv to uw.
        const int early = orientation(p, q, u, v), late = orientation(p, r, u, w);
        if (early > 0 || late < 0) return Meeting::none;
        const bool in_a_stretch = early < 0 && late > 0;
        if (shared_ == 1 && !in_a_stretch) return Meeting::none;
        if (in_a_stretch && straddles(0) && straddles(1)) return Meeting::crossing;
        for (std::size_t k : {0, 1})
            if (in_a_stretch && zeros(k) == 2 && straddles(1 - k)) standing_ = {int(k), lone[k], side_[k][lone[k]]};
        return Meeting::touching;
    }

    const std::vector<Vec3>& vertices_;
    Facet t_[2];
    std::array<std::array<bool, 3>, 2> common_{};
    std::array<std::array<int, 3>, 2> side_{};
    int shared_ = 0;
    Standing standing_;
};

inline bool has_area(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 u = b - a, v = c - a;
    if (norm2(cross(u, v)) > 0x1p-96 * norm2(u) * norm2(v)) return true;
    return orientation(Vec2{a.x, a.y}, Vec2{b.x, b.y}, Vec2{c.x, c.y}) != 0 ||
           orientation(Vec2{a.y, a.z}, Vec2{b.y, b.z}, Vec2{c.y, c.z}) != 0 ||
           orientation(Vec2{a.z, a.x}, Vec2{b.z, b.x}, Vec2{c.z, c.x}) != 0;
}

}  // namespace detail

// `limit`: at most so many crossings and overlaps, where the search stops, and so many touching pairs are listed.
inline Crossings find_crossings(const std::vector<Vec3>& vertices, std::vector<detail::Facet> faces, std::size_t limit) {
    Crossings result;
    std::vector<std::int32_t> number;  // of those that have an area
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const auto [a, b, c] = faces[f];
        if (detail::has_area(vertices[std::size_t(a)], vertices[std::size_t(b)], vertices[std::size_t(c)])) {
            faces[number.size()] = faces[f];
            number.push_back(std::int32_t(f));
        }
    }
    faces.resize(number.size());
    if (faces.empty()) return result;

    struct Found {
        std::int32_t first, second;
        Meeting kind;
    };
    // An edge that lies in a facet, and from which side. Where it has facets on both sides, the surface passes through.
    struct Stand {
        std::int32_t low, high, on;
        int side;
        std::size_t pair;
    };
    std::vector<Found> found;
    std::vector<Stand> stands;
    std::size_t listed[2] = {0, 0};
    // Facets that all reach the same place, such as a fan of needles, would take the square of their number.
    std::size_t looks = 50'000'000 + 100 * faces.size();
    const Surface surface(vertices, faces);
    surface.each_close_pair([&](std::int32_t f, std::int32_t g) {
        if (looks-- == 0) return result.complete = false;
        detail::FacetPair pair(vertices, faces[std::size_t(f)], faces[std::size_t(g)]);
        const Meeting kind = pair.meet();
        if (kind == Meeting::none) return true;
        ++result.count[std::size_t(kind)];
        if (listed[kind == Meeting::touching] == limit) return kind == Meeting::touching || (result.complete = false);
        ++listed[kind == Meeting::touching];
        if (const auto& s = pair.standing(); s.facet >= 0) {
            const auto& t = faces[std::size_t(s.facet == 0 ? f : g)];
            const auto [low, high] = std::minmax(t[(s.corner + 1) % 3], t[(s.corner + 2) % 3]);
            stands.push_back({low, high, s.facet == 0 ? g : f, s.side, found.size()});
        }
        found.push_back({f, g, kind});
        return true;
    });

    std::sort(stands.begin(), stands.end(), [](const Stand& a, const Stand& b) {
        return std::tie(a.low, a.high, a.on, a.side) < std::tie(b.low, b.high, b.on, b.side);
    });
    for (auto from = stands.begin(); from != stands.end();) {
        const auto to = std::find_if(from, stands.end(), [&](const Stand& s) {
            return std::tie(s.low, s.high, s.on) != std::tie(from->low, from->high, from->on);
        });
        if (from->side != (to - 1)->side)
            for (auto s = from; s != to; ++s) found[s->pair].kind = Meeting::crossing, --result.count[1], ++result.count[0];
        from = to;
    }
    std::sort(found.begin(), found.end(), [](const Found& a, const Found& b) {
        return std::tie(a.first, a.second) < std::tie(b.first, b.second);
    });
    result.pairs.reserve(2 * found.size());
    for (const Found& each : found) {
        result.pairs.push_back(number[std::size_t(each.first)]);
        result.pairs.push_back(number[std::size_t(each.second)]);
        result.kinds.push_back(std::uint8_t(each.kind));
    }
    return result;
}

}  // namespace contactbench
