// A probe, ready to be searched: geometry, neighbours, regions and the hierarchy over them.
//
// Contract
//   units      vertices in S-frame metres; `region` ranks facets: 0 none, 1 first priority, 2 next.
//   errors     std::invalid_argument for bad indices, vertices that are not finite, facets without
//              area, or a region list of the wrong length.
//   complexity O(n log n) time, about 450 bytes a facet. Immutable afterwards: share it freely
//              between threads.
#pragma once

#include "build.hpp"

namespace contactbench {

struct Model {
    Frame frame;
    std::vector<Vec3> vertices;    // S, m
    std::vector<Vec3> normalised;  // about frame.centre, over frame.scale
    std::vector<Vec3> normals;     // per face, unit, outward
    std::vector<std::int32_t> region;
    std::vector<std::int32_t> slot;  // face -> place in the hierarchy
    Topology topology;
    Hierarchy tree;
    double reach = 0.0;     // largest distance of a facet's corner from the sensor origin, m
    bool convex = false;    // closed and convex: at most one contact answers any wrench
};

namespace detail {

inline Frame bounding_frame(const std::vector<Vec3>& points, const std::vector<Triangle>& faces) {
    constexpr double inf = std::numeric_limits<double>::infinity();
    Vec3 lo{inf, inf, inf}, hi{-inf, -inf, -inf};
    for (const Triangle& t : faces)
        for (std::int32_t v : t) {
            const Vec3& p = points[std::size_t(v)];
            lo = {std::min(lo.x, p.x), std::min(lo.y, p.y), std::min(lo.z, p.z)};
            hi = {std::max(hi.x, p.x), std::max(hi.y, p.y), std::max(hi.z, p.z)};
        }
    const Vec3 half = 0.5 * (hi - lo);
    return {lo + half, std::max({half.x, half.y, half.z})};
}

inline bool in_one_piece(const Model& m, const std::vector<Triangle>& faces) {
    std::vector<char> seen(faces.size(), 0);
    std::vector<std::size_t> stack{0};
    std::size_t count = 1;
    for (seen[0] = 1; !stack.empty();) {
        const std::size_t f = stack.back();
        stack.pop_back();
        for (std::size_t c = 0; c < 3; ++c) {
            const std::size_t g = std::size_t(m.topology.twin(std::int32_t(3 * f + c))) / 3;
            if (!seen[g]) seen[g] = 1, ++count, stack.push_back(g);
        }
    }
    return count == faces.size();
}

// How often the surface winds around the middle of its box: 1 for a body that is wound once.
inline double winding_number(const Model& m, const std::vector<Triangle>& faces) {
    double total = 0.0;
    for (const Triangle& t : faces) {
        const Vec3 a = m.normalised[std::size_t(t[0])], b = m.normalised[std::size_t(t[1])],
                   c = m.normalised[std::size_t(t[2])];
        const double la = norm(a), lb = norm(b), lc = norm(c);
        // Solid angle of a triangle: van Oosterom and Strackee, 1983.
        total += 2.0 * std::atan2(dot(a, cross(b, c)),
                                  la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
    }
    return total / (4.0 * M_PI);
}

// Convex when the surface is closed, no facet rises above another's plane across their common edge, and
// it is wound once (two pieces, or a star wound twice, also look convex from every edge).
inline bool is_convex(const Model& m, const std::vector<Triangle>& faces) {
    if (!m.topology.closed()) return false;
    for (std::size_t h = 0; h < 3 * faces.size(); ++h) {
        const std::size_t t = std::size_t(m.topology.twin(std::int32_t(h)));
        const Vec3 apex = m.normalised[std::size_t(faces[t / 3][(t % 3 + 2) % 3])];
        const Vec3 base = m.normalised[std::size_t(faces[h / 3][h % 3])];
        if (dot(m.normals[h / 3], apex - base) > 1e-12) return false;
    }
    return in_one_piece(m, faces) && std::fabs(winding_number(m, faces) - 1.0) < 0.5;
}

}  // namespace detail

inline Model make_model(std::vector<Vec3> vertices, const std::vector<Triangle>& faces,
                        std::vector<std::int32_t> region) {
    check_triangles(faces, vertices.size());
    if (region.empty()) region.assign(faces.size(), 0);
    if (region.size() != faces.size())
        throw std::invalid_argument("region has " + std::to_string(region.size()) + " entries for " +
                                    std::to_string(faces.size()) + " facets");
    for (std::size_t v = 0; v < vertices.size(); ++v)
        if (!finite(vertices[v]))
            throw std::invalid_argument("vertex " + std::to_string(v) + " is not finite");
    Model m;
    m.vertices = std::move(vertices);
    m.region = std::move(region);
    for (std::size_t f = 0; f < m.region.size(); ++f)
        if (m.region[f] < 0)
            throw std::invalid_argument("facet " + std::to_string(f) + " has a negative region");
    m.frame = detail::bounding_frame(m.vertices, faces);
    if (!(m.frame.scale > 0.0) || !std::isfinite(m.frame.scale))
        throw std::invalid_argument("the mesh has no extent");
    for (const Vec3& p : m.vertices)
        m.normalised.push_back((1.0 / m.frame.scale) * (p - m.frame.centre));
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const auto at = [&](std::size_t c) { return m.normalised[std::size_t(faces[f][c])]; };
        const Vec3 n = cross(at(1) - at(0), at(2) - at(0));
        const double length = norm(n);
        const double longest = std::max({norm(at(1) - at(0)), norm(at(2) - at(1)), norm(at(0) - at(2))});
        // Thinner than this the normal is rounding; coordinates are of order one here.
        if (!(length > 1e-14 * longest))
            throw std::invalid_argument("facet " + std::to_string(f) + " has no area");
        m.normals.push_back((1.0 / length) * n);
        for (std::int32_t v : faces[f]) m.reach = std::max(m.reach, norm(m.vertices[std::size_t(v)]));
    }
    m.topology = Topology(faces, m.vertices.size());
    m.tree = detail::Builder(faces, m.normalised, m.normals, m.region, m.topology).build();
    m.slot.assign(faces.size(), -1);
    for (std::size_t s = 0; s < m.tree.face.size(); ++s)
        if (m.tree.face[s] >= 0) m.slot[std::size_t(m.tree.face[s])] = std::int32_t(s);
    m.convex = detail::is_convex(m, faces);
    return m;
}

}  // namespace contactbench
