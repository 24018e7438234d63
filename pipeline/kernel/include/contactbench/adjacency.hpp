// Which facets surround a vertex and which lie across each edge, on any triangles: open, closed or not manifold.
//
// Contract: indices are vertex numbers in [0, vertex_count); `check_triangles` says so. Construction is
// O(m log d), d the largest number of edges at a vertex, and the only part that allocates. A half-edge is
// 3 * facet + corner and runs from the corner's vertex to the next one. Unlike Topology nothing is asked of
// winding or of the number of facets at an edge: what is painted on has every defect that CAD can export.
#pragma once

#include <numeric>

#include "topology.hpp"

namespace contactbench {

class Adjacency {
public:
    struct Range {
        const std::int32_t *first, *last;
        const std::int32_t* begin() const { return first; }
        const std::int32_t* end() const { return last; }
        std::size_t size() const { return std::size_t(last - first); }
    };

    Adjacency(const std::vector<Triangle>& faces, std::size_t vertex_count) {
        link_vertices(faces, vertex_count);
        link_edges(faces, vertex_count);
    }

    // Facets that have the vertex as a corner, in ascending order.
    Range around(std::int32_t vertex) const { return range(facets_, vertex_start_, std::size_t(vertex)); }

    // Facets across a half-edge: one inside a manifold surface, none at a rim.
    Range across(std::int32_t half_edge) const { return range(neighbours_, edge_start_, std::size_t(half_edge)); }

    // For facet f the neighbours number edge_starts()[3 f] to edge_starts()[3 f + 3].
    const std::vector<std::int32_t>& edge_starts() const { return edge_start_; }
    const std::vector<std::int32_t>& neighbours() const { return neighbours_; }

private:
    // An edge of more facets than this links each to the next only: still connected, but not quadratic.
    static constexpr std::size_t crowd = 8;

    struct Entry {
        std::int32_t other, half_edge;
    };

    static Range range(const std::vector<std::int32_t>& values, const std::vector<std::int32_t>& start,
                       std::size_t i) {
        return {values.data() + start[i], values.data() + start[i + 1]};
    }

    void link_vertices(const std::vector<Triangle>& faces, std::size_t vertex_count) {
        vertex_start_.assign(vertex_count + 1, 0);
        for (const Triangle& t : faces)
            for (std::int32_t v : t) ++vertex_start_[std::size_t(v) + 1];
        std::partial_sum(vertex_start_.begin(), vertex_start_.end(), vertex_start_.begin());
        facets_.resize(3 * faces.size());
        std::vector<std::int32_t> place(vertex_start_.begin(), vertex_start_.end() - 1);
        for (std::size_t f = 0; f < faces.size(); ++f)
            for (std::int32_t v : faces[f]) facets_[std::size_t(place[std::size_t(v)]++)] = std::int32_t(f);
    }

    // Half-edges in buckets by their lower vertex: a counting sort, then small sorts, beat one large sort fourfold.
    void link_edges(const std::vector<Triangle>& faces, std::size_t vertex_count) {
        const auto ends = [&](std::size_t h) {
            const std::int32_t a = faces[h / 3][h % 3], b = faces[h / 3][(h + 1) % 3];
            return std::pair{std::min(a, b), std::max(a, b)};
        };
        const std::size_t count = 3 * faces.size();
        std::vector<std::size_t> start(vertex_count + 1, 0);
        for (std::size_t h = 0; h < count; ++h) ++start[std::size_t(ends(h).first) + 1];
        std::partial_sum(start.begin(), start.end(), start.begin());
        std::vector<Entry> entries(count);
        std::vector<std::size_t> place(start.begin(), start.end() - 1);
        for (std::size_t h = 0; h < count; ++h) {
            const auto [low, high] = ends(h);
            entries[place[std::size_t(low)]++] = {high, std::int32_t(h)};
        }
        for (std::size_t v = 0; v < vertex_count; ++v)
            std::sort(entries.begin() + std::ptrdiff_t(start[v]), entries.begin() + std::ptrdiff_t(start[v + 1]),
                      [](const Entry& p, const Entry& q) {
                          return p.other != q.other ? p.other < q.other : p.half_edge < q.half_edge;
                      });
        store(entries, start);
    }

    void store(const std::vector<Entry>& entries, const std::vector<std::size_t>& start) {
        edge_start_.assign(entries.size() + 1, 0);
        each_edge(entries, start, [&](std::size_t i, std::size_t n) {
            for (std::size_t k = 0; k < n; ++k)
                edge_start_[std::size_t(entries[i + k].half_edge) + 1] = std::int32_t(n > crowd ? 2 : n - 1);
        });
        std::partial_sum(edge_start_.begin(), edge_start_.end(), edge_start_.begin());
        neighbours_.resize(std::size_t(edge_start_.back()));
        each_edge(entries, start, [&](std::size_t i, std::size_t n) {
            const auto facet = [&](std::size_t k) { return entries[i + k % n].half_edge / 3; };
            for (std::size_t k = 0; k < n; ++k) {
                std::int32_t* out = neighbours_.data() + edge_start_[std::size_t(entries[i + k].half_edge)];
                if (n > crowd) {
                    out[0] = facet(k + n - 1);
                    out[1] = facet(k + 1);
                    continue;
                }
                for (std::size_t j = 0; j < n; ++j)
                    if (j != k) *out++ = facet(j);
            }
        });
    }

    template <class Visit>
    static void each_edge(const std::vector<Entry>& entries, const std::vector<std::size_t>& start, Visit visit) {
        for (std::size_t v = 0; v + 1 < start.size(); ++v)
            for (std::size_t i = start[v], j; i < start[v + 1]; i = j) {
                for (j = i; j < start[v + 1] && entries[j].other == entries[i].other; ++j) {
                }
                visit(i, j - i);
            }
    }

    std::vector<std::int32_t> vertex_start_, facets_, edge_start_, neighbours_;
};

}  // namespace contactbench
