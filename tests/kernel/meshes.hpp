// Meshes to test on, from well-behaved to nasty, and wrenches that press on them.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "check.hpp"
#include "contactbench/solver.hpp"

namespace testing {

using contactbench::Model;
using contactbench::Triangle;
using contactbench::Vec3;
using contactbench::Wrench;
using contactbench::WrenchCovariance;

struct Mesh {
    std::string name;
    std::vector<Vec3> vertices;
    std::vector<Triangle> faces;
};

inline Mesh octahedron() {
    return {"octahedron",
            {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
            {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
}

// Every facet into four.
inline Mesh subdivide(const Mesh& m) {
    Mesh out{m.name, m.vertices, {}};
    std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middles;
    const auto middle = [&](std::int32_t a, std::int32_t b) {
        const auto [it, fresh] =
            middles.try_emplace({std::min(a, b), std::max(a, b)}, std::int32_t(out.vertices.size()));
        if (fresh) out.vertices.push_back(0.5 * (out.vertices[std::size_t(a)] + out.vertices[std::size_t(b)]));
        return it->second;
    };
    for (const Triangle& t : m.faces) {
        const std::int32_t a = middle(t[0], t[1]), b = middle(t[1], t[2]), c = middle(t[2], t[0]);
        out.faces.insert(out.faces.end(), {{t[0], a, c}, {a, t[1], b}, {c, b, t[2]}, {a, b, c}});
    }
    return out;
}

template <class Move>
Mesh moved(Mesh m, std::string name, Move&& move) {
    m.name = std::move(name);
    for (Vec3& p : m.vertices) p = move(p);
    return m;
}

inline Mesh sphere(int levels, double radius = 0.03) {
    Mesh m = octahedron();
    for (int i = 0; i < levels; ++i) m = subdivide(m);
    return moved(m, "sphere", [=](Vec3 p) { return (radius / contactbench::norm(p)) * p; });
}

inline Mesh ellipsoid(int levels) {
    return moved(sphere(levels, 1.0), "ellipsoid", [](Vec3 p) {
        return Vec3{0.02 * p.x + 0.01, 0.035 * p.y, 0.06 * p.z + 0.1};
    });
}

// A head on a neck: a sphere squeezed in the middle and spread at the far end.
inline Mesh t_shape(int levels) {
    return moved(sphere(levels, 1.0), "T-shape", [](Vec3 p) {
        const double spread = 0.3 + 1.7 / (1.0 + std::exp(-14.0 * (p.z - 0.5)));
        return Vec3{0.03 * spread * p.x, 0.012 * (0.6 + 0.4 * spread) * p.y, 0.07 * p.z + 0.07};
    });
}

inline Mesh torus(int around, int across) {
    Mesh m{"torus", {}, {}};
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j) {
            const double a = 2.0 * M_PI * i / around, b = 2.0 * M_PI * j / across;
            const double r = 0.04 + 0.015 * std::cos(b);
            m.vertices.push_back({r * std::cos(a), r * std::sin(a), 0.015 * std::sin(b) + 0.02});
        }
    const auto at = [&](int i, int j) { return std::int32_t((i % around) * across + j % across); };
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j) {
            m.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            m.faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return m;
}

inline Mesh box() {
    Mesh m{"box", {}, {}};
    for (int i = 0; i < 8; ++i) m.vertices.push_back({0.01 * (i & 1), 0.02 * (i >> 1 & 1), 0.04 * (i >> 2)});
    m.faces = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
               {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return m;
}

inline Mesh single() { return {"single", {{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0.001}}, {{0, 1, 2}}}; }

// The upper half of a ball, its rim open.
inline Mesh open_shell(int levels) {
    Mesh m = sphere(levels);
    m.name = "open";
    std::vector<Triangle> kept;
    for (const Triangle& t : m.faces) {
        double z = 0.0;
        for (std::int32_t v : t) z += m.vertices[std::size_t(v)].z;
        if (z > 0.01) kept.push_back(t);
    }
    m.faces = kept;
    return m;
}

// Unrelated triangles, some of them sharing vertices at random.
inline Mesh soup(std::size_t facets, std::uint64_t seed) {
    Random random(seed);
    Mesh m{"soup", {}, {}};
    for (std::size_t i = 0; i < 2 * facets; ++i) m.vertices.push_back(0.03 * random.normal3());
    while (m.faces.size() < facets) {
        const auto pick = [&] { return std::int32_t(random.below(m.vertices.size())); };
        const Triangle t{pick(), pick(), pick()};
        if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) m.faces.push_back(t);
    }
    return m;
}

// Both in one list.
inline Mesh joined(Mesh m, const Mesh& other, std::string name) {
    const auto first = std::int32_t(m.vertices.size());
    m.name = std::move(name);
    m.vertices.insert(m.vertices.end(), other.vertices.begin(), other.vertices.end());
    for (const Triangle& t : other.faces) m.faces.push_back({t[0] + first, t[1] + first, t[2] + first});
    return m;
}

inline Mesh two_pieces(int levels) { return joined(sphere(levels, 0.02), ellipsoid(levels), "two pieces"); }

// A box of many facets.
inline Mesh slab(int levels, Vec3 size, Vec3 corner) {
    Mesh m = box();
    for (int i = 0; i < levels; ++i) m = subdivide(m);
    return moved(m, "slab", [=](Vec3 p) {
        return corner + Vec3{p.x / 0.01 * size.x, p.y / 0.02 * size.y, p.z / 0.04 * size.z};
    });
}

// Three plates one above the other: a force across them may press on any.
inline Mesh plates() {
    const auto plate = [](double z) { return slab(2, {0.05, 0.05, 0.002}, {-0.025, -0.025, z}); };
    return joined(joined(plate(0.0), plate(0.012), ""), plate(0.024), "plates");
}

// A fin of 0.8 mm on a block: its edge is narrower than the axis is known.
inline Mesh fin() {
    return joined(slab(2, {0.04, 0.04, 0.02}, {-0.02, -0.02, 0.0}), slab(3, {0.0008, 0.03, 0.02}, {0.0, -0.015, 0.02}), "fin");
}

// Every third facet twice or three times: ties that only the facet's number breaks.
inline Mesh duplicated(int levels) {
    Mesh m = ellipsoid(levels);
    m.name = "duplicated";
    for (std::size_t f = 0, n = m.faces.size(); f < n; f += 3)
        for (std::size_t i = 0; i < 1 + f % 2; ++i) m.faces.push_back(m.faces[f]);
    return m;
}

inline Mesh badly_wound(int levels, std::uint64_t seed) {
    Random random(seed);
    Mesh m = t_shape(levels);
    m.name = "badly wound";
    for (Triangle& t : m.faces)
        if (random.below(4) == 0) std::swap(t[1], t[2]);
    return m;
}

// Needles and caps: a sphere squashed to a sheet, with vertices pushed almost onto their neighbours.
inline Mesh slivers(int levels, std::uint64_t seed) {
    Random random(seed);
    Mesh m = moved(sphere(levels, 1.0), "slivers", [&](Vec3 p) {
        return Vec3{0.05 * p.x, 1e-5 * p.y, 0.02 * p.z + 1e-7 * random.normal()};
    });
    // Each vertex at most once: facets thinner than the rounding of their corners have no normal to test.
    std::vector<char> touched(m.vertices.size(), 0);
    for (const Triangle& t : m.faces) {
        const auto a = std::size_t(t[0]), b = std::size_t(t[1]);
        if (random.below(8) != 0 || touched[a] || touched[b]) continue;
        touched[a] = touched[b] = 1;
        m.vertices[a] = m.vertices[b] + 1e-6 * (m.vertices[a] - m.vertices[b]);
    }
    return m;
}

// A ball of dents and spikes.
inline Mesh urchin(int levels, std::uint64_t seed) {
    Random random(seed);
    return moved(sphere(levels, 1.0), "urchin", [&](Vec3 p) { return (0.03 * random.uniform(0.3, 1.0)) * p; });
}

inline std::vector<Mesh> zoo() {
    return {octahedron(),  box(),         single(),      sphere(3),         ellipsoid(3),  t_shape(3), torus(64, 32),
            open_shell(3), soup(200, 11), two_pieces(2), badly_wound(3, 5), slivers(3, 7), urchin(3, 3), plates(),
            fin(),         duplicated(2)};
}

// A place on the mesh, and how the tissue presses there.
struct Touch {
    Vec3 point, normal, force;
    double torque = 0.0;

    Wrench wrench() const { return {force, cross(point, force) + torque * normal}; }
};

// `steepest`: largest friction angle, rad; `pitch`: torque over force, as a share of the mesh size.
inline Touch random_touch(const Model& m, Random& random, double steepest, double pitch) {
    const std::size_t f = random.below(m.normals.size());
    const Triangle& t = m.faces[f];
    double a = random.unit(), b = random.unit();
    if (a + b > 1.0) a = 1.0 - a, b = 1.0 - b;
    const Vec3 p = m.vertices[std::size_t(t[0])], q = m.vertices[std::size_t(t[1])], r = m.vertices[std::size_t(t[2])];
    Touch touch;
    touch.point = p + (a * (q - p) + b * (r - p));
    touch.normal = m.normals[f];
    Vec3 side = cross(touch.normal, random.direction());
    side = (1.0 / norm(side)) * side;
    const double angle = steepest * random.unit(), size = random.uniform(1.0, 20.0);
    touch.force = size * (-std::cos(angle) * touch.normal + std::sin(angle) * side);
    touch.torque = pitch * size * m.frame.scale * random.normal();
    return touch;
}

// A touch that is likely to find trouble: on corners, on edges, edge-on, along the axes, beside the mesh.
inline Touch nasty_touch(const Mesh& mesh, const Model& m, Random& random, double pitch) {
    Touch touch = random_touch(m, random, random.below(3) ? 1.5 : 1.5707963267948966, pitch);
    const Triangle& t = mesh.faces[random.below(mesh.faces.size())];
    const Vec3 a = mesh.vertices[std::size_t(t[0])], b = mesh.vertices[std::size_t(t[1])];
    const Vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    switch (random.below(8)) {
        case 0: touch.point = a; break;
        case 1: touch.point = 0.5 * (a + b); break;
        case 2: touch.point = a + random.unit() * (b - a); break;
        case 3: touch.force = (10.0 / norm(b - a)) * (b - a); break;
        case 4: touch.force = (random.below(2) ? 5.0 : -5.0) * axes[random.below(3)]; break;
        case 5: touch.point = touch.point + m.frame.scale * random.normal3(); break;
        default: break;
    }
    return touch;
}

// Of a common sensor: 0.05 N and 2 mN*m, `times` as much.
inline WrenchCovariance noise_of(double times = 1.0) {
    WrenchCovariance noise;
    for (int i = 0; i < 6; ++i) noise.s[i][i] = times * times * (i < 3 ? 0.0025 : 4e-6);
    return noise;
}

// The same size, every channel correlated with every other.
inline WrenchCovariance mixed_noise(Random& random, double force = 0.05, double torque = 0.002) {
    double root[6][6];
    WrenchCovariance noise;
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j) root[i][j] = (i < 3 ? force : torque) * (double(i == j) + 0.5 * random.normal());
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j)
            for (int k = 0; k < 6; ++k) noise.s[i][j] += root[i][k] * root[j][k];
    return noise;
}

}  // namespace testing
