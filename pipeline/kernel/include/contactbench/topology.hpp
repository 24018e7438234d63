// Which facet lies behind which edge.
//
// Contract: indices are vertex numbers in [0, vertex_count); faces are counter-clockwise seen from
// outside. Construction is O(m log m) in the facets and the only part that allocates.
// A half-edge is 3 * facet + corner and runs from the corner's vertex to the next one.
// Throws std::invalid_argument for an index out of range or a facet that uses a vertex twice.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "vec.hpp"

namespace contactbench {

using Triangle = std::array<std::int32_t, 3>;

inline void check_triangles(const std::vector<Triangle>& faces, std::size_t vertex_count) {
    if (faces.empty()) throw std::invalid_argument("a mesh needs at least one facet");
    if (faces.size() > std::size_t(std::numeric_limits<std::int32_t>::max()) / 4)
        throw std::invalid_argument("a mesh may have at most 536870911 facets");
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const Triangle& t = faces[f];
        for (int v : t)
            if (v < 0 || std::size_t(v) >= vertex_count)
                throw std::invalid_argument("facet " + std::to_string(f) + " names vertex " +
                                            std::to_string(v) + ", but there are " +
                                            std::to_string(vertex_count) + " vertices");
        if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0])
            throw std::invalid_argument("facet " + std::to_string(f) + " uses a vertex twice");
    }
}

class Topology {
public:
    static constexpr std::int32_t none = -1;

    Topology() = default;
    explicit Topology(const std::vector<Triangle>& faces) { link_twins(faces); }

    // The half-edge that runs the other way on the same edge, or `none` on a rim, a non-manifold
    // edge or between facets of opposite winding.
    std::int32_t twin(std::int32_t half_edge) const { return twin_[std::size_t(half_edge)]; }

    // Every edge has exactly two facets of matching winding.
    bool closed() const { return closed_; }

private:
    void link_twins(const std::vector<Triangle>& faces) {
        struct Edge {
            std::uint64_t key;
            std::int32_t half_edge;
            bool forward;
        };
        std::vector<Edge> edges;
        edges.reserve(3 * faces.size());
        for (std::size_t f = 0; f < faces.size(); ++f)
            for (int c = 0; c < 3; ++c) {
                const auto a = std::uint32_t(faces[f][std::size_t(c)]);
                const auto b = std::uint32_t(faces[f][std::size_t((c + 1) % 3)]);
                const std::uint64_t lo = std::min(a, b), hi = std::max(a, b);
                edges.push_back({lo << 32 | hi, std::int32_t(3 * f) + c, a < b});
            }
        std::sort(edges.begin(), edges.end(), [](const Edge& p, const Edge& q) {
            return p.key != q.key ? p.key < q.key : p.half_edge < q.half_edge;
        });
        twin_.assign(edges.size(), none);
        closed_ = true;
        for (std::size_t i = 0, j; i < edges.size(); i = j) {
            for (j = i; j < edges.size() && edges[j].key == edges[i].key; ++j) {
            }
            if (j - i == 2 && edges[i].forward != edges[i + 1].forward) {
                twin_[std::size_t(edges[i].half_edge)] = edges[i + 1].half_edge;
                twin_[std::size_t(edges[i + 1].half_edge)] = edges[i].half_edge;
            } else {
                closed_ = false;
            }
        }
    }

    std::vector<std::int32_t> twin_;
    bool closed_ = false;
};

}  // namespace contactbench
