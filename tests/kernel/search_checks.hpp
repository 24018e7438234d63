// Bounds are bounds, and the pruned search finds what looking at every facet finds.
#pragma once

#include <cstring>
#include <stdexcept>

#include "facet_checks.hpp"

namespace testing {

using contactbench::Answer;
using contactbench::Bounds;
using contactbench::Candidate;
using contactbench::Float8;
using contactbench::Solver;

// Of what a bound leaves: how near to the truth it is where there is something to prune.
struct Tightness {
    double sum = 0.0;
    long count = 0;

    void add(double bound, double truth) {
        if (truth < 10.0) return;
        sum += bound / truth;
        ++count;
    }
    double mean() const { return sum / double(count); }
};

// No node and no leaf promises more than the best of its facets has.
class BoundChecks {
public:
    BoundChecks(const Mesh& mesh, const contactbench::MeshTerms& terms)
        : mesh_(mesh), model_(contactbench::make_model(mesh.vertices, mesh.faces, {}, {}, terms)),
          flats_(flats_of(mesh, model_, terms)) {}

    const Model& model() const { return model_; }

    void check(const Case& c, double cap) {
        const Query q = c.query(model_);
        if (norm2(q.m) > 1e6) return;  // not searched: see far_moment
        const Definition d = c.definition(model_);
        truth_.clear();
        for (const Flat& flat : flats_) {
            const double cosine = -double(inner(flat.normal, d.f));
            truth_.push_back({cosine < cap ? HUGE_VAL : double(d.best(flat).d2), cosine});
        }
        cap_ = cap;
        node_ = contactbench::make_node_query(q, cap);
        form_ = contactbench::in_lanes(q.form);
        check_node(model_.tree.root(), model_.tree.level_of(model_.tree.root()));
    }

    Tightness nodes, leaves;

private:
    struct Truth {
        double d2 = HUGE_VAL, cosine = -1.0;
    };

    static bool below(float bound, double truth) { return double(bound) <= truth * (1.0 + 1e-7) + 1e-12; }

    // The best inside the friction cone, and the largest cosine of all.
    Truth best(std::size_t first_block, std::size_t last_block) const {
        Truth out;
        for (std::size_t s = first_block * contactbench::lanes; s < last_block * contactbench::lanes; ++s) {
            if (model_.tree.face[s] < 0) continue;
            const Truth& t = truth_[std::size_t(model_.tree.face[s])];
            if (t.cosine >= cap_) out.d2 = std::min(out.d2, t.d2);
            out.cosine = std::max(out.cosine, t.cosine);
        }
        return out;
    }

    // Checks a subtree and returns the blocks that it holds.
    std::pair<std::size_t, std::size_t> check_node(std::int32_t index, int level) {
        const contactbench::Node& node = model_.tree.nodes[std::size_t(index)];
        const Bounds bounds = contactbench::node_bound(node, contactbench::boxes_of(node), node_);
        std::pair<std::size_t, std::size_t> all{SIZE_MAX, 0};
        const auto children = model_.tree.children(index, level);
        for (int l = 0; l < contactbench::lanes; ++l) {
            if (!(children.which >> l & 1u)) continue;
            const std::int32_t child = children.first + l;
            std::pair<std::size_t, std::size_t> blocks{std::size_t(child), std::size_t(child) + 1};
            if (level == 0) check_leaf(blocks.first);
            else blocks = check_node(child, level - 1);
            const Truth t = best(blocks.first, blocks.second);
            if (t.cosine >= cap_) {
                CHECK(below(bounds.d2[l], t.d2));
                nodes.add(double(bounds.d2[l]), t.d2);
            }
            all = {std::min(all.first, blocks.first), std::max(all.second, blocks.second)};
        }
        return all;
    }

    void check_leaf(std::size_t index) {
        const contactbench::Leaf& leaf = model_.tree.leaves[index];
        // All there is to know, and what is known where nothing can be below what is asked for.
        const Bounds bounds = contactbench::leaf_bound(leaf, form_, node_, 1e30f);
        const Bounds first = contactbench::leaf_bound(leaf, form_, node_, 0.0f);
        for (std::size_t l = 0; l < contactbench::lanes; ++l) {
            const std::int32_t face = model_.tree.face[index * contactbench::lanes + l];
            if (face < 0 || truth_[std::size_t(face)].cosine < cap_) continue;
            const double d2 = truth_[std::size_t(face)].d2;
            CHECK(below(bounds.d2[int(l)], d2));
            CHECK(first.d2[int(l)] <= bounds.d2[int(l)]);
            leaves.add(double(bounds.d2[int(l)]), d2);
        }
    }

    Mesh mesh_;
    Model model_;
    std::vector<Flat> flats_;
    std::vector<Truth> truth_;
    double cap_ = 0.0;
    contactbench::NodeQuery node_;
    contactbench::Form<Float8> form_;
};

inline void check_bounds() {
    Random random(11);
    Tightness nodes, leaves;
    const auto run = [&](const Mesh& mesh, int rounds) {
        const double size = contactbench::detail::bounding_frame(mesh.vertices, mesh.faces).scale / 0.06;
        BoundChecks checks(mesh, {random.below(2) ? 0.0 : 1e-4 * size, random.below(4) != 0});
        const double pitches[] = {0.0, 1e-3, 0.01, 0.1, 1.0, 30.0}, precisions[] = {1e-3, 0.1, 1.0, 1.0, 1.0, 10.0, 1e3};
        const double arms[] = {0.0, 1e-4, 1e-3, 1e-3, 0.03, 1.0}, caps[] = {0.9, 0.2588, 0.2588, 0.2588, 0.0175, 1e-3};
        for (int i = 0; i < rounds; ++i) {
            Case c;
            const double precision = precisions[random.below(7)];
            c.noise = mixed_noise(random, 0.05 * precision, 0.002 * size * precision);
            c.arm = size * arms[random.below(6)];
            c.wrench = nasty_touch(mesh, checks.model(), random, pitches[random.below(6)]).wrench();
            checks.check(c, caps[random.below(6)]);
        }
    };
    for (const Mesh& mesh : zoo()) run(mesh, 25);
    for (const double scale : {1e-3, 0.1, 30.0, 1e3})
        for (const double offset : {0.0, 3.0, 100.0}) {
            const Vec3 place = (0.06 * offset) * random.direction();
            for (const Mesh& base : {t_shape(2), slivers(2, 7), fin()})
                run(moved(base, "scaled", [=](Vec3 p) { return scale * (p + place); }), 10);
        }
    // Large facets and a sensor so precise that the rounding of corners is what counts.
    {
        BoundChecks checks(octahedron(), {0.0, false});
        for (int i = 0; i < 200; ++i) {
            Touch touch = random_touch(checks.model(), random, 0.5, 0.0);
            touch.point = touch.point + random.uniform(1e-5, 1e-3) * random.normal3();
            checks.check({touch.wrench(), mixed_noise(random, 1e-8, 1e-8), 0.0}, 0.2588);
        }
    }
    // A common probe, sensor and touch: here bounds have to be tight too, or nothing is pruned.
    for (const Mesh& mesh : {ellipsoid(4), t_shape(4)}) {
        BoundChecks checks(mesh, {});
        for (int i = 0; i < 10; ++i)
            checks.check({random_touch(checks.model(), random, 0.5, 0.01).wrench(), noise_of(), 1e-3}, 0.2588);
        nodes.sum += checks.nodes.sum, nodes.count += checks.nodes.count;
        leaves.sum += checks.leaves.sum, leaves.count += checks.leaves.count;
    }
    std::printf("bounds over true misfits: %.2f of nodes, %.2f of facets\n", nodes.mean(), leaves.mean());
    CHECK(nodes.mean() > 0.2 && leaves.mean() > 0.9);
}

// A long rod, an imprecise force and a precise torque: near the sensor V is what is left of terms that cancel.
inline void check_cancelled_terms() {
    const double length = 1.4343102209210326;
    const Mesh rod = moved(sphere(3, 1.0), "rod", [=](Vec3 p) { return Vec3{0.01 * p.x, 0.01 * p.y, 0.5 * length * (p.z + 1.0)}; });
    WrenchCovariance noise;
    for (int i = 0; i < 6; ++i) noise.s[i][i] = i < 3 ? 164.06226732051545 : 5.0276676077872819e-11;
    const Solver solver(std::make_shared<const Model>(contactbench::make_model(rod.vertices, rod.faces, {})), noise, 1e-3, {});
    const Wrench w{{-0.33823503947947769, 0.82294434217805135, -2.5841280641583229},
                   {-0.041046683058082997, -0.0077006279929483336, 0.0033717955016251411}};
    const Answer found = solver.locate(w), truth = solver.locate_exhaustively(w);
    CHECK(truth.count > 0 && found.count == truth.count && found.misfit == truth.misfit);
}

inline bool same_bits(Vec3 a, Vec3 b) { return std::memcmp(&a, &b, sizeof a) == 0; }

// Not a number is equal to itself.
inline bool same_number(double a, double b) { return a == b || (a != a && b != b); }

inline bool same_candidate(const Candidate& a, const Candidate& b) {
    return same_bits(a.point, b.point) && same_bits(a.normal, b.normal) && a.torque == b.torque && a.cosine == b.cosine &&
           a.misfit == b.misfit && a.prior == b.prior && a.follow == b.follow && a.behind == b.behind &&
           a.across == b.across && a.depth == b.depth && a.face == b.face && a.vertex == b.vertex && a.region == b.region && a.slot == b.slot &&
           a.why == b.why;
}

inline bool same_answer(const Answer& a, const Answer& b) {
    if (a.reason != b.reason || a.count != b.count || a.chosen != b.chosen || a.has_second != b.has_second) return false;
    for (int i = 0; i < a.count; ++i)
        if (!same_candidate(a.candidates[i], b.candidates[i])) return false;
    return same_number(a.misfit, b.misfit) && same_number(a.left_over, b.left_over) && same_number(a.arm, b.arm) &&
           a.confidence == b.confidence && (!a.has_second || same_candidate(a.second, b.second));
}

// Regions at random, with odds for the second and odds against the third; the first only has a number.
struct Declared {
    std::vector<std::int32_t> region;
    std::vector<double> bonus;

    Declared() = default;
    Declared(const Mesh& mesh, Random& random) {
        region.resize(mesh.faces.size());
        for (std::int32_t& r : region) r = std::int32_t(random.below(4));
        const double odds = random.below(2) ? 13.815510557964274 : 4.0;
        for (const std::int32_t r : region) bonus.push_back(r == 2 ? odds : r == 3 ? -odds : 0.0);
    }
};

struct Subject {
    Mesh mesh;
    Declared declared;
    contactbench::MeshTerms terms;
    WrenchCovariance noise;
    double arm = 1e-3;
    bool learned = false;
    Gates gates;
    std::shared_ptr<const Model> model;

    Solver solver() {
        model = std::make_shared<const Model>(
            contactbench::make_model(mesh.vertices, mesh.faces, declared.region, declared.bonus, terms));
        return Solver(model, noise, {arm, learned}, gates);
    }
};

// Everything that may be told to a solver, at random.
inline Subject random_subject(Mesh mesh, Random& random, double size = 1.0) {
    Subject s;
    s.mesh = std::move(mesh);
    if (random.below(2)) s.declared = Declared(s.mesh, random);
    s.terms = {random.below(2) ? 0.0 : 1e-4 * size, random.below(4) != 0};
    const double precision = (const double[]){0.01, 0.3, 1.0, 1.0, 1.0, 5.0, 50.0}[random.below(7)];
    s.noise = mixed_noise(random, 0.05 * precision, 0.002 * size * precision);
    s.arm = size * (const double[]){0.0, 1e-4, 1e-3, 1e-3, 0.01, 1.0}[random.below(6)];
    Gates& g = s.gates;
    g.cos_friction = (const double[]){0.9, 0.2588, 0.2588, 0.05, 0.0}[random.below(5)];
    g.implausible_misfit = (const double[]){10.83, 10.83, 3.84, 40.0}[random.below(4)];
    g.rival_cost = (const double[]){9.21, 9.21, 4.0, 0.0}[random.below(4)];
    g.behind_cost = random.below(4) ? 4.0 : 0.0;
    g.ambiguity_distance = (const double[]){0.005, 0.005, 0.001, 0.0}[random.below(4)] * size;
    g.behind_distance = 0.003 * size;
    g.follow_distance = 0.01 * size;
    g.depth_distance = random.below(4) ? 0.002 * size : 0.0;
    g.min_force = 0.0;
    g.region_only = random.below(8) == 0;
    return s;
}

inline Wrench random_wrench(const Subject& s, Random& random) {
    const double pitches[] = {0.0, 0.0, 1e-8, 1e-3, 0.01, 0.03, 0.1, 1.0, 30.0, 900.0, 5000.0};
    Wrench w = nasty_touch(s.mesh, *s.model, random, pitches[random.below(random.below(4) ? 6 : 11)]).wrench();
    if (random.below(2)) {
        w.F = w.F + 0.05 * random.normal3();
        w.M = w.M + (0.03 * s.model->frame.scale) * random.normal3();
    }
    return w;
}

// Where a contact may have been last: near a touch, or anywhere.
inline Vec3 random_previous(const Subject& s, Random& random) {
    return random_touch(*s.model, random, 1.0, 0.0).point + (0.01 * s.model->frame.scale) * random.normal3();
}

inline void check_same_answers(const Mesh& mesh, int subjects, int rounds, std::uint64_t seed, double size = 1.0) {
    Random random(seed);
    for (int k = 0; k < subjects; ++k) {
        Subject s = random_subject(mesh, random, size);
        const Solver solver = s.solver();
        for (int i = 0; i < rounds; ++i) {
            const Wrench w = random_wrench(s, random);
            const Vec3 previous = random_previous(s, random);
            const Vec3* last = random.below(3) == 0 ? &previous : nullptr;
            CHECK(same_answer(solver.locate(w, last), solver.locate_exhaustively(w, last)));
        }
    }
}

// Size and place of a mesh must not matter: 1 um to 1 km, and up to 10^4 mesh sizes off the sensor.
inline void check_sizes() {
    const Mesh base = t_shape(3);
    for (const double scale : {1.0, 2e-5, 2e4})
        for (const double offset : {0.0, 15.0, 1e4}) {
            const Mesh mesh = moved(base, "scaled",
                                    [=](Vec3 p) { return scale * (p + Vec3{offset * 0.06, -offset * 0.03, 0.0}); });
            check_same_answers(mesh, 2, 25, 31, scale);
        }
}

// Beyond far_moment nothing is searched: no touch explains it, and the misfit told is none too large.
inline void check_far_moment() {
    const Mesh mesh = sphere(3);
    Subject s;
    s.mesh = mesh, s.noise = noise_of();
    const Solver solver = s.solver();
    const std::vector<Flat> flats = flats_of(mesh, *s.model);
    Random random(41);
    for (int i = 0; i < 60; ++i) {
        Touch touch = random_touch(*s.model, random, 1.0, 0.0);
        const double moment = (i % 2 ? 1.5 : 0.5) * contactbench::far_moment * norm(touch.force) * s.model->frame.scale;
        if (i % 4 < 2) touch.torque = moment;
        else touch.point = (moment / norm(touch.force)) * cross(random.direction(), (1.0 / norm(touch.force)) * touch.force);
        const Answer a = solver.locate(touch.wrench());
        CHECK(same_answer(a, solver.locate_exhaustively(touch.wrench())));
        CHECK(a.reason == Reason::implausible || a.reason == Reason::off_surface);
        if (a.reason != Reason::implausible) continue;
        const Definition d(touch.wrench(), s.noise, s.arm, s.model->frame.centre, s.model->frame.scale);
        const Verdict v = judge(flats, d, s.gates, nullptr);
        CHECK(a.misfit >= s.gates.implausible_misfit);
        if (v.reason == Reason::implausible) CHECK(a.misfit <= double(v.misfit) * (1.0 + 1e-9));
    }
}

template <class Make>
bool refuses(Make&& make) {
    try {
        make();
    } catch (const std::invalid_argument&) {
        return true;
    }
    return false;
}

inline void check_refusals() {
    const std::vector<Vec3> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}};
    const auto make = [&](std::vector<Vec3> v, std::vector<Triangle> f, std::vector<std::int32_t> r = {},
                          std::vector<double> odds = {}, contactbench::MeshTerms terms = {}) {
        return refuses([&] { (void)contactbench::make_model(std::move(v), f, std::move(r), odds, terms); });
    };
    CHECK(!make(corners, {{0, 1, 2}}));
    CHECK(make(corners, {}));
    CHECK(make({}, {{0, 1, 2}}));
    CHECK(make(corners, {{0, 1, 4}}));
    CHECK(make(corners, {{0, 1, -1}}));
    CHECK(make(corners, {{0, 1, 1}}));
    CHECK(make(corners, {{0, 1, 3}}));
    CHECK(make(corners, {{0, 1, 2}}, {1, 2}));
    CHECK(make(corners, {{0, 1, 2}}, {-1}));
    CHECK(!make(corners, {{0, 1, 2}}, {1}, {-13.8}, {1e-4, true}));
    CHECK(make(corners, {{0, 1, 2}}, {1}, {1.0, 2.0}));
    CHECK(make(corners, {{0, 1, 2}}, {1}, {101.0}));
    CHECK(make(corners, {{0, 1, 2}}, {1}, {NAN}));
    CHECK(make(corners, {{0, 1, 2}}, {}, {}, {-1e-4, true}));
    CHECK(make(corners, {{0, 1, 2}}, {}, {}, {NAN, true}));
    CHECK(make(corners, {{0, 1, 2}}, {}, {}, {HUGE_VAL, true}));
    CHECK(make({{0, 0, 0}, {NAN, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}));
    CHECK(make({{0, 0, 0}, {HUGE_VAL, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}));
    CHECK(make({{-1.7e308, 0, 0}, {1.7e308, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}));
}

inline void check_zoo() {
    std::uint64_t seed = 100;
    for (const Mesh& mesh : zoo()) check_same_answers(mesh, 8, 40, ++seed);
    check_same_answers(sphere(5), 4, 10, 120);  // more is open than can be kept
}

inline void check_search() {
    check_bounds();
    check_cancelled_terms();
    check_zoo();
    check_same_answers(sphere(6), 2, 6, 200);  // four levels of nodes
    check_sizes();
    check_far_moment();
    check_refusals();
}

}  // namespace testing
