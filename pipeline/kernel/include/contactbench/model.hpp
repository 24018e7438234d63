// A probe, ready to be searched: geometry, neighbours, regions and the hierarchy over them.
//
// Contract
//   units      vertices in S-frame metres; `region` numbers facets: 0 none; `bonus` is 2 ln(odds) of a touch on each.
//   errors     std::invalid_argument for bad indices, vertices that are not finite, facets without
//              area, or a region list of the wrong length.
//   complexity O(n log n) time, about 110 bytes a facet. Immutable afterwards: share it freely
//              between threads.
#pragma once

#include <map>

#include "build.hpp"

namespace contactbench {

// One facet in full: normalised corners, the lowest vertex number first, winding kept.
struct Facet {
    Vec3 corner[3], normal;
    MeshError<double> error;
};

struct Model {
    Frame frame;
    std::vector<Vec3> vertices;              // S, m
    std::vector<Triangle> faces;             // the lowest vertex number first, winding kept
    std::vector<Vec3> normals;               // unit, outward
    std::vector<MeshError<double>> errors;  // of each face
    bool closed = false;                     // every edge has exactly two facets of matching winding
    Hierarchy tree;
    double reach = 0.0;  // largest distance of a facet's corner from the sensor origin, m
    double most_bonus = 0.0;

    // About frame.centre, over frame.scale.
    Vec3 normalised(std::int32_t vertex) const {
        return (1.0 / frame.scale) * (vertices[std::size_t(vertex)] - frame.centre);
    }
    Facet facet(std::int32_t face) const {
        const Triangle& t = faces[std::size_t(face)];
        return {{normalised(t[0]), normalised(t[1]), normalised(t[2])}, normals[std::size_t(face)], errors[std::size_t(face)]};
    }
    std::int32_t region(std::int32_t face) const { return kinds[std::size_t(kind[std::size_t(face)])].first; }
    double bonus(std::int32_t face) const { return kinds[std::size_t(kind[std::size_t(face)])].second; }

    // Region and 2 ln(odds), of which a probe has few.
    std::vector<std::pair<std::int32_t, double>> kinds;
    std::vector<std::int32_t> kind;  // of each face
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

// Sharper edges than this are edges of the probe; others are where facets stand for a curved surface.
inline constexpr double sharpest_cosine = 0.7660444431189780;  // of 40 degrees

// What a facet of a curved surface leaves open, told from how far its normal turns to its neighbours'. Where the normal
// turns evenly by theta from the middle of one facet to that of the next, it is off by half of that at the edge, and the
// surface arches over the chord by theta / 8 of its width. Curvature is least even where facets are large, on roundings,
// so the bound itself is taken for the normal, and 0.7 of the arch for the surface: with the root mean squares of an
// even curvature (0.35 theta, 0.3 of the arch) the 95 % ellipse held 89 % on 500 facets; so it holds 92 to 96.
inline std::vector<MeshError<double>> curvature_errors(const Model& m, const std::vector<Triangle>& faces,
                                                       const std::vector<Vec3>& normalised, const Topology& topology) {
    std::vector<MeshError<double>> errors(faces.size());
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const auto middle = [&](std::size_t g) {
            return (1.0 / 3.0) * (normalised[std::size_t(faces[g][0])] + normalised[std::size_t(faces[g][1])] +
                                  normalised[std::size_t(faces[g][2])]);
        };
        double turn = 0.0, arch = 0.0;
        for (std::size_t c = 0; c < 3; ++c) {
            const std::int32_t twin = topology.twin(std::int32_t(3 * f + c));
            if (twin == Topology::none) continue;
            const std::size_t g = std::size_t(twin) / 3;
            const double cosine = dot(m.normals[f], m.normals[g]);
            if (cosine < sharpest_cosine) continue;
            const double theta = std::acos(std::min(1.0, cosine));
            turn = std::max(turn, theta);
            arch = std::max(arch, theta * norm(middle(f) - middle(g)));
        }
        errors[f].bend = 0.5 * turn * (0.5 * turn);
        errors[f].spread = 0.7 / 8.0 * arch * (0.7 / 8.0 * arch);
    }
    return errors;
}

}  // namespace detail

// What is known of how far the mesh is from the true surface.
struct MeshTerms {
    double deviation = 0.0;  // m, root mean square along the normal, everywhere
    bool curved = true;      // facets stand for a curved surface where they turn by little
};

inline Model make_model(std::vector<Vec3> vertices, const std::vector<Triangle>& faces,
                        std::vector<std::int32_t> region, const std::vector<double>& bonus = {},
                        const MeshTerms& terms = {}) {
    check_triangles(faces, vertices.size());
    if (region.empty()) region.assign(faces.size(), 0);
    std::vector<double> odds = bonus;
    if (odds.empty()) odds.assign(faces.size(), 0.0);
    if (odds.size() != faces.size())
        throw std::invalid_argument("bonus has " + std::to_string(odds.size()) + " entries for " +
                                    std::to_string(faces.size()) + " facets");
    for (std::size_t f = 0; f < odds.size(); ++f)
        if (!(std::fabs(odds[f]) <= 100.0))
            throw std::invalid_argument("facet " + std::to_string(f) + " has odds beyond e^50");
    if (!(terms.deviation >= 0.0) || !std::isfinite(terms.deviation))
        throw std::invalid_argument("the deviation of the mesh is not a length");
    if (region.size() != faces.size())
        throw std::invalid_argument("region has " + std::to_string(region.size()) + " entries for " +
                                    std::to_string(faces.size()) + " facets");
    for (std::size_t v = 0; v < vertices.size(); ++v)
        if (!finite(vertices[v]))
            throw std::invalid_argument("vertex " + std::to_string(v) + " is not finite");
    Model m;
    m.vertices = std::move(vertices);
    for (std::size_t f = 0; f < region.size(); ++f)
        if (region[f] < 0)
            throw std::invalid_argument("facet " + std::to_string(f) + " has a negative region");
    m.frame = detail::bounding_frame(m.vertices, faces);
    if (!(m.frame.scale > 0.0) || !std::isfinite(m.frame.scale))
        throw std::invalid_argument("the mesh has no extent");
    std::vector<Vec3> normalised;
    normalised.reserve(m.vertices.size());
    for (std::size_t v = 0; v < m.vertices.size(); ++v) normalised.push_back(m.normalised(std::int32_t(v)));
    m.normals.reserve(faces.size());
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const auto at = [&](std::size_t c) { return normalised[std::size_t(faces[f][c])]; };
        const Vec3 n = cross(at(1) - at(0), at(2) - at(0));
        const double length = norm(n);
        const double longest = std::max({norm(at(1) - at(0)), norm(at(2) - at(1)), norm(at(0) - at(2))});
        // Thinner than this the normal is rounding; coordinates are of order one here.
        if (!(length > 1e-14 * longest))
            throw std::invalid_argument("facet " + std::to_string(f) + " has no area");
        m.normals.push_back((1.0 / length) * n);
        for (std::int32_t v : faces[f]) m.reach = std::max(m.reach, norm(m.vertices[std::size_t(v)]));
    }
    {
        const Topology topology(faces);
        m.closed = topology.closed();
        m.errors = terms.curved ? detail::curvature_errors(m, faces, normalised, topology)
                                : std::vector<MeshError<double>>(faces.size());
    }
    const double deviation = terms.deviation / m.frame.scale;
    for (MeshError<double>& e : m.errors) e.spread += deviation * deviation;
    m.tree = detail::Builder(faces, normalised, m.normals, m.errors, odds).build();
    m.faces = faces;
    for (Triangle& t : m.faces) t = lowest_first(t);
    std::map<std::pair<std::int32_t, double>, std::int32_t> known;
    m.kind.reserve(faces.size());
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const auto [at, added] = known.try_emplace({region[f], odds[f]}, std::int32_t(m.kinds.size()));
        if (added) m.kinds.push_back(at->first);
        m.kind.push_back(at->second);
    }
    m.most_bonus = *std::max_element(odds.begin(), odds.end());
    return m;
}

}  // namespace contactbench
