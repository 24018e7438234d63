// Ray queries by madmann91/bvh (v2), whose checkout `--bvh` names: the first hit, or all of them.
//
// A shared library for compiled.py. Built and traversed as its own example does: best quality, facets in the tree's
// order, the fast test of boxes.
#include <limits>
#include <memory>

#include <bvh/v2/bvh.h>
#include <bvh/v2/default_builder.h>
#include <bvh/v2/node.h>
#include <bvh/v2/ray.h>
#include <bvh/v2/stack.h>
#include <bvh/v2/tri.h>
#include <bvh/v2/vec.h>

#include "rows.hpp"

namespace {

using Node = bvh::v2::Node<float, 3>;
using Tree = bvh::v2::Bvh<Node>;
using Vec3 = bvh::v2::Vec<float, 3>;
using Ray = bvh::v2::Ray<float, 3>;
using Stack = bvh::v2::SmallStack<Tree::Index, 64>;

struct Scene {
    Tree tree;
    std::vector<bvh::v2::PrecomputedTri<float>> facets;
};

Vec3 vector(const float* v) { return {v[0], v[1], v[2]}; }

// Calls `met(facet, distance)` for facets that the ray meets; where `met` shortens the ray, only for nearer ones after.
template <class Met>
void trace(const Scene& s, Ray& ray, const Met& met) {
    Stack stack;
    s.tree.intersect<false, false>(ray, s.tree.get_root().index, stack, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            if (const auto hit = s.facets[i].intersect(ray)) met(i, std::get<0>(*hit));
        return false;
    });
}

}  // namespace

extern "C" void* hits_new(const float* vertices, const std::int32_t* facets, std::int64_t facet_count) {
    std::vector<bvh::v2::Tri<float, 3>> given;
    std::vector<bvh::v2::BBox<float, 3>> boxes;
    std::vector<Vec3> centres;
    for (std::int64_t i = 0; i < facet_count; ++i) {
        const std::int32_t* c = facets + 3 * i;
        given.emplace_back(vector(vertices + 3 * c[0]), vector(vertices + 3 * c[1]), vector(vertices + 3 * c[2]));
        boxes.push_back(given.back().get_bbox());
        centres.push_back(given.back().get_center());
    }
    auto scene = std::make_unique<Scene>();
    bvh::v2::DefaultBuilder<Node>::Config config;
    config.quality = bvh::v2::DefaultBuilder<Node>::Quality::High;
    scene->tree = bvh::v2::DefaultBuilder<Node>::build(boxes, centres, config);
    for (const std::size_t facet : scene->tree.prim_ids) scene->facets.emplace_back(given[facet]);
    return scene.release();
}

extern "C" void hits_drop(void* scene) { delete static_cast<Scene*>(scene); }

// `facets` and `far` (count): -1 where a ray meets nothing.
extern "C" void hits_first(const void* scene, const float* origins, const float* directions, std::int64_t count,
                           int threads, std::int32_t* facets, float* far) {
    const auto& s = *static_cast<const Scene*>(scene);
    each_stretch(count, threads, [&](std::int64_t from, std::int64_t to) {
        for (std::int64_t i = from; i < to; ++i) {
            Ray ray(vector(origins + 3 * i), vector(directions + 3 * i));
            std::size_t nearest = s.facets.size();
            trace(s, ray, [&](std::size_t facet, float distance) { nearest = facet, ray.tmax = distance; });
            const bool hit = nearest < s.facets.size();
            facets[i] = hit ? std::int32_t(s.tree.prim_ids[nearest]) : -1;
            far[i] = hit ? ray.tmax : -1.0f;
        }
    });
}

// `counts` (count): how many a ray meets; the first `room` that the tree gives in `facets` and `far` (count, room).
extern "C" void hits_all(const void* scene, const float* origins, const float* directions, std::int64_t count,
                         int threads, std::int32_t room, std::int32_t* counts, std::int32_t* facets, float* far) {
    const auto& s = *static_cast<const Scene*>(scene);
    each_stretch(count, threads, [&](std::int64_t from, std::int64_t to) {
        for (std::int64_t i = from; i < to; ++i) {
            Ray ray(vector(origins + 3 * i), vector(directions + 3 * i));
            std::int32_t found = 0;
            trace(s, ray, [&](std::size_t facet, float distance) {
                if (found < room)
                    facets[i * room + found] = std::int32_t(s.tree.prim_ids[facet]), far[i * room + found] = distance;
                ++found;
            });
            counts[i] = found;
        }
    });
}
