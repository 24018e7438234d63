// The exhaustive scan over structure-of-arrays: every facet of the mesh, eight at a time, no pruning.
//
// It is the simplest complete method and, up to a thousand facets or so, among the fastest; beyond, it
// is what the hierarchy is measured against.
//
// Contract: facets in slot order, dimensionless constants as in facets.hpp. Same operations in the same
// order as `accepts`, so it finds the same facets to the bit. O(n), no allocation after construction.
#pragma once

#include "search.hpp"

namespace contactbench {

class ScanTable {
public:
    explicit ScanTable(const Model& model) : blocks_(model.tree.leaves.size()) {
        for (std::size_t slot = 0; slot < model.tree.face.size(); ++slot) {
            if (model.tree.face[slot] < 0) continue;  // padding stays zero, and 0 < 0 is never true
            Block& block = blocks_[slot / lanes];
            const std::size_t lane = slot % lanes;
            for (std::size_t e = 0; e < 3; ++e)
                for (std::size_t i = 0; i < 6; ++i) block.edge[e][i][lane] = model.tree.edges[slot].edge[e][i];
            // w <= 0 spelled as w < the smallest double, so that both tie rules are one comparison.
            block.tie[lane] =
                rises(model.tree.triangle[slot]) ? std::numeric_limits<double>::denorm_min() : 0.0;
        }
    }

    // Calls `hit(slot, w)` for every facet that accepts the wrench, in slot order.
    template <class Hit>
    void visit(const Query& q, Hit&& hit) const {
        for (std::size_t b = 0; b < blocks_.size(); ++b) {
            alignas(64) double w[3][lanes];
            for (unsigned mask = accept_mask(blocks_[b], q, w); mask != 0; mask &= mask - 1) {
                const std::size_t l = std::size_t(std::countr_zero(mask));
                const double moments[3] = {w[0][l], w[1][l], w[2][l]};
                hit(b * lanes + l, moments);
            }
        }
    }

private:
    struct alignas(64) Block {
        double edge[3][6][lanes] = {};
        double tie[lanes] = {};
    };

    CONTACTBENCH_INLINE static unsigned accept_mask(const Block& block, const Query& q, double (*out)[lanes]) {
        unsigned mask = 0;
        for (int half = 0; half < lanes; half += 4) {  // the widest double vector that AVX2 has
            Double4 w[3];
            for (int e = 0; e < 3; ++e) {
                const auto& c = block.edge[e];
                w[e] = ((q.m.x * load4(c[0] + half) + q.m.y * load4(c[1] + half)) + q.m.z * load4(c[2] + half)) +
                       ((q.f.x * load4(c[3] + half) + q.f.y * load4(c[4] + half)) + q.f.z * load4(c[5] + half));
                std::memcpy(out[e] + half, &w[e], sizeof w[e]);
            }
            mask |= truth_mask((w[0] <= 0.0) & (w[1] < load4(block.tie + half)) & (w[2] < 0.0)) << half;
        }
        return mask;
    }

    std::vector<Block> blocks_;
};

// All accepted facets, then all vertices. Equal to `exhaust`.
inline void scan(const ScanTable& table, const Model& model, const Query& q, double cos_cap, Hits& hits) {
    table.visit(q, [&](std::size_t slot, const double* w) {
        const Candidate c = facet_contact(model, slot, w, q);
        if (c.cosine >= std::max(cos_cap, least_cosine)) hits.add(c);
    });
    for (std::size_t v = 0; v < model.vertices.size(); ++v)
        detail::test_vertex(model, std::int32_t(v), q, cos_cap, hits);
}

}  // namespace contactbench
