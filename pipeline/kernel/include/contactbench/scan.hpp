// The exhaustive closed form over structure-of-arrays, to be measured against: every facet of the mesh, eight at a time,
// no pruning, no noise and no doubt; of those that hold a solution, the one of the smallest local torque.
//
// For a directed edge a -> b let w(a, b) = M . (b - a) + F . (a x b), the moment of the wrench about the edge's line.
// With p x F + k n = M and n . p = n . a it equals F . ((a - p) x (b - p)), twice the signed area that p spans with the
// edge times n . F. So a counter-clockwise facet holds the solution of a pushing wrench exactly when w < 0 on its three
// edges, whatever k, and the three values are the barycentric coordinates of p.
//
// Contract: facets in slot order. w == 0 counts as negative on the half-edge that runs from the lower vertex number to
// the higher one, so a point on a shared edge belongs to exactly one facet. O(n), no allocation after construction.
#pragma once

#include "answer.hpp"

namespace contactbench {

class ScanTable {
public:
    explicit ScanTable(const Model& model) : blocks_(model.tree.leaves.size()) {
        for (std::size_t slot = 0; slot < model.tree.face.size(); ++slot) {
            if (model.tree.face[slot] < 0) continue;  // padding stays zero, and 0 < 0 is never true
            Block& block = blocks_[slot / lanes];
            const Triangle& t = model.faces[std::size_t(model.tree.face[slot])];
            const Facet facet = model.facet(model.tree.face[slot]);
            const std::size_t lane = slot % lanes;
            for (std::size_t e = 0; e < 3; ++e) {
                // Computed upwards and negated for the twin, so that both halves agree to the bit.
                const bool up = t[e] < t[(e + 1) % 3];
                const Vec3 a = facet.corner[up ? e : (e + 1) % 3], b = facet.corner[up ? (e + 1) % 3 : e];
                const Vec3 along = up ? b - a : a - b, moment = up ? cross(a, b) : -cross(a, b);
                const double values[6] = {along.x, along.y, along.z, moment.x, moment.y, moment.z};
                for (std::size_t i = 0; i < 6; ++i) block.edge[e][i][lane] = values[i];
            }
            // w <= 0 spelled as w < the smallest double, so that both tie rules are one comparison.
            block.tie[lane] = t[1] < t[2] ? std::numeric_limits<double>::denorm_min() : 0.0;
        }
    }

    // The solution of the smallest local torque within the friction cone; false: there is none.
    bool locate(const Model& model, const Wrench& wrench, double cos_friction, Candidate& out) const {
        const double force = norm(wrench.F);
        const Vec3 f = (1.0 / force) * wrench.F;
        const Vec3 m = (1.0 / (force * model.frame.scale)) * (wrench.M - cross(model.frame.centre, wrench.F));
        const double pitch = dot(m, f);
        bool found = false;
        for (std::size_t b = 0; b < blocks_.size(); ++b) {
            alignas(64) double w[3][lanes];
            for (unsigned mask = accept_mask(blocks_[b], f, m, w); mask != 0; mask &= mask - 1) {
                const std::size_t l = std::size_t(std::countr_zero(mask)), slot = b * lanes + l;
                const double cosine = -dot(model.normals[std::size_t(model.tree.face[slot])], f);
                if (cosine < std::max(cos_friction, 1e-9) || (found && cosine <= out.cosine)) continue;
                found = true;
                out = solution(model, slot, {w[0][l], w[1][l], w[2][l]});
                out.cosine = cosine;
                out.torque = -force * model.frame.scale * pitch / cosine;
            }
        }
        return found;
    }

private:
    struct alignas(64) Block {
        double edge[3][6][lanes] = {};
        double tie[lanes] = {};
    };

    static Candidate solution(const Model& model, std::size_t slot, std::array<double, 3> w) {
        const Triangle& t = model.faces[std::size_t(model.tree.face[slot])];
        const auto vertex = [&](std::size_t c) { return model.vertices[std::size_t(t[c])]; };
        const double total = w[0] + w[1] + w[2];
        Candidate c;
        c.face = model.tree.face[slot];
        c.slot = std::int32_t(slot);
        c.normal = model.normals[std::size_t(c.face)];
        c.region = model.region(c.face);
        c.point = (w[1] / total) * vertex(0) + ((w[2] / total) * vertex(1) + (w[0] / total) * vertex(2));
        return c;
    }

    CONTACTBENCH_INLINE static unsigned accept_mask(const Block& block, Vec3 f, Vec3 m, double (*out)[lanes]) {
        unsigned mask = 0;
        for (int half = 0; half < lanes; half += 4) {  // the widest double vector that AVX2 has
            Double4 w[3];
            for (int e = 0; e < 3; ++e) {
                const auto& c = block.edge[e];
                w[e] = ((m.x * load4(c[0] + half) + m.y * load4(c[1] + half)) + m.z * load4(c[2] + half)) +
                       ((f.x * load4(c[3] + half) + f.y * load4(c[4] + half)) + f.z * load4(c[5] + half));
                std::memcpy(out[e] + half, &w[e], sizeof w[e]);
            }
            mask |= truth_mask((w[0] <= 0.0) & (w[1] < load4(block.tie + half)) & (w[2] < 0.0)) << half;
        }
        return mask;
    }

    std::vector<Block> blocks_;
};

}  // namespace contactbench
