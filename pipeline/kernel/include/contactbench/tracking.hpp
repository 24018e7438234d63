// Following a stream: a cut through the hierarchy that is valid for every wrench near a reference.
//
// A walk over neighbouring facets finds *a* contact in constant time, but on a non-convex probe, and
// every real one is, it cannot vouch that no other facet accepts the wrench too. A cut can: it is the set
// of subtrees that could hold a contact of any wrench within reach of the reference, flattened into a
// few nodes. As long as the stream stays within reach, a search from the cut gives exactly what one
// from the root gives, without the upper levels; when it leaves, the cut is made anew around the
// present wrench. Nothing is guessed, so tracking and a cold solve cannot differ.
//
// Contract: one Tracker per stream; not thread-safe. No allocation after construction.
#pragma once

#include "search.hpp"

namespace contactbench {

class Cut {
public:
    static constexpr int capacity = 12 * lanes;

    // Every subtree that may matter within (turn, shift) of q, opened level by level while it fits.
    void build(const Hierarchy& tree, const Query& q, double cos_cap, double turn, double shift) {
        const NodeQuery wide = widen(make_node_query(q, cos_cap, push_sign(q)), q, cos_cap, turn, shift);
        Place level[capacity], next[capacity];
        int count = open(tree, 0, wide, level, 0);
        for (bool grew = true; grew;) {
            grew = false;
            int n = 0;
            for (int i = 0; i < count; ++i) {
                const std::int32_t child = tree.nodes[std::size_t(level[i].node)].child[level[i].lane];
                const int rest = count - i - 1;
                if (child < 0 || n + lanes + rest > capacity) {
                    next[n++] = level[i];
                } else {
                    n = open(tree, child, wide, next, n);
                    grew = true;
                }
            }
            std::copy(next, next + n, level);
            count = n;
        }
        pack(tree, level, count);
        reference_ = q;
        turn_ = turn, shift_ = shift;
    }

    bool covers(const Query& q) const {
        return size_ >= 0 && norm2(q.f - reference_.f) <= turn_ * turn_ &&
               norm2(q.m - reference_.m) <= shift_ * shift_;
    }

    void clear() { size_ = -1; }

    const Node* begin() const { return nodes_.data(); }
    const Node* end() const { return nodes_.data() + std::max(size_, 0); }

private:
    struct Place {
        std::int32_t node, lane;
    };

    static int open(const Hierarchy& tree, std::int32_t index, const NodeQuery& wide, Place* places, int count) {
        const Node& node = tree.nodes[std::size_t(index)];
        for (unsigned mask = node_mask(node, wide); mask != 0; mask &= mask - 1) {
            const int lane = std::countr_zero(mask);
            if (node.child[lane] != empty_child) places[count++] = {index, lane};
        }
        return count;
    }

    void pack(const Hierarchy& tree, const Place* places, int count) {
        size_ = (count + lanes - 1) / lanes;
        for (int i = 0; i < size_ * lanes; ++i) {
            Node& to = nodes_[std::size_t(i / lanes)];
            const int l = i % lanes;
            to.child[l] = empty_child;
            if (i >= count) continue;
            const Node& from = tree.nodes[std::size_t(places[i].node)];
            const int s = places[i].lane;
            to.cx[l] = from.cx[s], to.cy[l] = from.cy[s], to.cz[l] = from.cz[s];
            to.ex[l] = from.ex[s], to.ey[l] = from.ey[s], to.ez[l] = from.ez[s];
            to.ax[l] = from.ax[s], to.ay[l] = from.ay[s], to.az[l] = from.az[s];
            to.cos_a[l] = from.cos_a[s], to.sin_a[l] = from.sin_a[s], to.cos2_a[l] = from.cos2_a[s];
            to.radius[l] = from.radius[s];
            to.child[l] = from.child[s];
        }
    }

    std::array<Node, capacity / lanes> nodes_;
    int size_ = -1;
    Query reference_;
    double turn_ = 0.0, shift_ = 0.0;
};

inline void search_from(const Cut& cut, const Model& model, const Query& q, double cos_cap, Hits& hits) {
    const NodeQuery nq = make_node_query(q, cos_cap, push_sign(q));
    test_leaves(model, q, nq, cos_cap, hits, [&](auto&& leaf) {
        NodeStack stack;
        const auto test = [&](const Node& n) { return node_mask(n, nq); };
        for (const Node& node : cut) {
            push_children(model.tree.nodes.data(), node, test(node), stack, leaf);
            descend(model.tree.nodes.data(), stack, test, leaf);
        }
    });
}

// Chooses how far a cut should reach: widely enough to last, tightly enough to be short.
class Tracker {
public:
    // Standard deviations of one sample's force direction (rad) and scaled moment: a cut should outlast
    // the noise. `cos_cap` as in search.
    void search(const Model& model, const Query& q, double cos_cap, double turn_noise, double shift_noise,
                Hits& hits) {
        if (!prunable(q)) return exhaust(model, q, cos_cap, hits);
        if (!cut_.covers(q)) {
            // Left soon after it was made: the contact moves fast, reach further. Outlived its use:
            // a shorter one is cheaper. A miss costs one rebuild, about two cold searches.
            if (served_ < 32) growth_ = std::min(2.0 * growth_, 8.0);
            if (served_ > 512) growth_ = std::max(0.5 * growth_, 1.0);
            served_ = 0;
            const double turn = std::min(growth_ * std::max(5.0 * turn_noise, 0.01), 0.3);
            const double shift = std::min(growth_ * std::max(5.0 * shift_noise, 0.01), 0.3);
            cut_.build(model.tree, q, cos_cap, turn, shift);
        }
        ++served_;
        search_from(cut_, model, q, cos_cap, hits);
    }

    void reset() {
        cut_.clear();
        growth_ = 1.0;
        served_ = 0;
    }

private:
    Cut cut_;
    double growth_ = 1.0;
    std::int64_t served_ = 0;
};

}  // namespace contactbench
