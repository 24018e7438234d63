// A probe, ready to be searched: geometry, neighbours, regions and the hierarchy over them.
//
// Contract
//   units      vertices in S-frame metres; `region` numbers facets: 0 none; `bonus` is 2 ln(odds) of a touch on each.
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
    double least_bonus = 0.0, most_bonus = 0.0;
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
inline std::vector<MeshError<double>> curvature_errors(const Model& m, const std::vector<Triangle>& faces) {
    std::vector<MeshError<double>> errors(faces.size());
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const auto middle = [&](std::size_t g) {
            return (1.0 / 3.0) * (m.normalised[std::size_t(faces[g][0])] + m.normalised[std::size_t(faces[g][1])] +
                                  m.normalised[std::size_t(faces[g][2])]);
        };
        double turn = 0.0, arch = 0.0;
        for (std::size_t c = 0; c < 3; ++c) {
            const std::int32_t twin = m.topology.twin(std::int32_t(3 * f + c));
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
    m.topology = Topology(faces);
    auto errors = terms.curved ? detail::curvature_errors(m, faces) : std::vector<MeshError<double>>(faces.size());
    const double deviation = terms.deviation / m.frame.scale;
    for (MeshError<double>& e : errors) e.spread += deviation * deviation;
    m.tree = detail::Builder(faces, m.normalised, m.normals, errors, odds).build();
    m.slot.assign(faces.size(), -1);
    for (std::size_t s = 0; s < m.tree.face.size(); ++s)
        if (m.tree.face[s] >= 0) m.slot[std::size_t(m.tree.face[s])] = std::int32_t(s);
    m.least_bonus = *std::min_element(odds.begin(), odds.end());
    m.most_bonus = *std::max_element(odds.begin(), odds.end());
    return m;
}

}  // namespace contactbench
