// Strokes over triangles of every kind: each facet is told once, the picked ones always, and it ends.
#pragma once

#include <set>

#include "check.hpp"
#include "contactbench/brush.hpp"

namespace testing {

// Few distinct coordinates, so that corners coincide, facets are flat and edges have many of them.
inline contactbench::SurfaceMesh soup(Random& random, bool huge) {
    std::vector<contactbench::Vec3> vertices(3 + random.below(30));
    const double step = random.below(2) ? 0.5 : 0.01;
    for (contactbench::Vec3& v : vertices) {
        v = {std::round(random.uniform(-2, 2) / step) * step, random.uniform(-2, 2), double(random.below(5))};
    }
    if (huge) vertices[0] = {1e300, -1e300, 1e-300};
    std::vector<contactbench::Triangle> faces{{0, 1, 2}};
    for (std::size_t i = random.below(80); i > 0; --i) {
        const auto corner = [&] { return std::int32_t(random.below(vertices.size())); };
        const contactbench::Triangle t{corner(), corner(), corner()};
        if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) faces.push_back(t);
    }
    return {vertices, faces};
}

inline void check_geodesic() {
    Random random(20);
    for (int round = 0; round < 250; ++round) {
        const contactbench::SurfaceMesh mesh = soup(random, round % 50 == 0);
        contactbench::Brush brush(mesh);
        for (int stroke = 0; stroke < 3; ++stroke) {
            brush.begin(std::pow(10.0, random.uniform(-12, 3)), random.below(2) == 0);
            std::set<std::int32_t> covered;
            for (int event = 0; event < 6; ++event) {
                const auto face = std::int32_t(random.below(mesh.faces.size()));
                const bool corner = random.below(4) == 0;
                const contactbench::Vec3 point = corner ? mesh.corner(face, 0) : mesh.centroid(face);
                for (std::int32_t f : brush.extend({face, point}, random.below(5) != 0))
                    CHECK(covered.insert(f).second);
                CHECK(covered.count(face) == 1);
            }
        }
    }
}

}  // namespace testing
