// The solver as a whole: what it says of a wrench, streams, gates, memory, and the methods it is compared with.
#pragma once

#include "contactbench/algorithm1.hpp"
#include "contactbench/paraboloid.hpp"
#include "contactbench/scan.hpp"
#include "search_checks.hpp"

namespace testing {

// Counts every allocation of the program; defined in test_kernel.cpp.
long allocations();

// One answer against the verdict of reference.hpp.
inline void check_against(const Answer& a, const Verdict& v, const Model& m) {
    const double size = m.frame.scale;
    CHECK(a.reason == v.reason);
    CHECK(std::size_t(a.count) == v.places.size());
    CHECK(a.chosen == v.chosen);
    CHECK(std::fabs(a.confidence - double(v.confidence)) <= 1e-5);
    const auto close_or_unknown = [](double mine, Real want, double scale) {
        return (mine != mine) == (want != want) && !(std::fabs(mine - double(want)) > 1e-6 * (std::fabs(double(want)) + scale));
    };
    CHECK(close_or_unknown(a.misfit, v.misfit, 1.0));
    CHECK(close_or_unknown(a.left_over, v.left_over, size));
    for (int i = 0; i < a.count && std::size_t(i) < v.places.size(); ++i) {
        const Candidate& c = a.candidates[i];
        const Place& p = v.places[std::size_t(i)];
        CHECK(double(length(Real3(c.point) - p.point)) <= 1e-6 * (size + double(p.across)));
        CHECK(double(length(Real3(c.normal) - p.flat->normal)) <= 1e-6);
        CHECK(std::fabs(c.misfit - double(p.d2)) <= 1e-6 * (1.0 + double(p.d2)));
        CHECK(close(c.across, double(p.across), 1e-5));
        CHECK(std::fabs(c.depth - double(p.depth)) <= 1e-5 * double(p.depth) + contactbench::tie);
        CHECK(close(c.cosine, double(p.cosine), 1e-6, 1.0));
        CHECK(c.prior == double(p.prior) && c.follow == double(p.follow) && c.behind == double(p.behind));
        CHECK(c.region == p.flat->region && (c.vertex >= 0) == (p.vertex >= 0));
        CHECK(c.why == p.why);
    }
}

// What is said of a wrench is what follows from the best touch on every facet, taken one by one.
inline void check_judgement() {
    Random random(45);
    int count[contactbench::reason_count] = {}, doubtful = 0, rounds = 0;
    for (const Mesh& mesh : zoo())
        for (int k = 0; k < 4; ++k) {
            Subject s = random_subject(mesh, random);
            const Solver solver = s.solver();
            const std::vector<Flat> flats = flats_of(mesh, *s.model, s.terms, s.declared.bonus);
            for (int i = 0; i < 16; ++i) {
                // Half of them common touches, of which much may be said.
                const Wrench w = i % 2 ? random_wrench(s, random) : random_touch(*s.model, random, 1.2, 0.01).wrench();
                const Definition d(w, s.noise, s.arm, s.model->frame.centre, s.model->frame.scale);
                const Real moment = (length(d.axis - d.middle) + std::fabs(d.pitch) / d.force) / d.size;
                if (moment > contactbench::far_moment / 2) continue;
                const Vec3 previous = random_previous(s, random);
                const Vec3* last = random.below(3) == 0 ? &previous : nullptr;
                const Verdict v = judge(flats, d, s.gates, last);
                ++rounds;
                if (v.doubtful) {
                    ++doubtful;
                    continue;
                }
                ++count[int(v.reason)];
                const Answer a = solver.locate(w, last);
                check_against(a, v, *s.model);
                CHECK(close(a.arm, double(d.pitch / d.force), 1e-9, s.model->frame.scale));
                const Candidate* c = a.contact();
                if (!c) continue;
                const contactbench::Mat3 whole = solver.covariance(w, c->point, c->normal, c->face, c->depth, s.arm),
                                         flat = solver.covariance(w, c->point, c->normal, c->face, 0.0, s.arm);
                const Real f[3] = {d.f.x, d.f.y, d.f.z}, depth2 = c->depth * c->depth;
                for (int j = 0; j < 3; ++j)
                    for (int l = 0; l < 3; ++l)
                        CHECK(close(whole.m[j][l], flat.m[j][l] + double(depth2 * f[j] * f[l]), 1e-9, double(depth2)));
            }
        }
    CHECK(doubtful < rounds / 4);
    for (const Reason r : {Reason::ok, Reason::vertex, Reason::ambiguous, Reason::by_region, Reason::implausible,
                           Reason::tangential, Reason::outside_region, Reason::off_surface})
        CHECK(count[int(r)] > 5);
}

// On an edge between untouchable and other facets of a plane either explains the wrench: the lowest number is told.
inline void check_seams() {
    Random random(47);
    int told = 0;
    for (int k = 0; k < 20; ++k) {
        Subject s;
        s.mesh = plates(), s.noise = noise_of(), s.declared = Declared(s.mesh, random);
        for (double& bonus : s.declared.bonus) bonus = std::min(bonus, 0.0);
        const Solver solver = s.solver();
        const std::vector<Flat> flats = flats_of(s.mesh, *s.model, s.terms, s.declared.bonus);
        for (int i = 0; i < 40; ++i) {
            const Triangle& t = s.mesh.faces[random.below(s.mesh.faces.size())];
            const double share = random.uniform(0.1, 0.9);
            const auto corner = [&](int c) { return s.mesh.vertices[std::size_t(t[std::size_t(c)])]; };
            Touch touch;
            touch.point = share * corner(0) + (1.0 - share) * corner(2);
            touch.normal = cross(corner(1) - corner(0), corner(2) - corner(0));
            touch.force = (-8.0 / norm(touch.normal)) * touch.normal;
            const Wrench w = touch.wrench();
            const Verdict v = judge(flats, {w, s.noise, s.arm, s.model->frame.centre, s.model->frame.scale}, s.gates, nullptr);
            const Answer a = solver.locate(w);
            if (v.doubtful || v.places.empty() || !CHECK(a.count > 0)) continue;
            CHECK(a.candidates[0].face == v.places[0].flat->face);
            ++told;
        }
    }
    CHECK(told > 400);
}

// Three plates of 2 mm, 12 mm apart, pressed from above: which of them is touched, one wrench cannot tell.
inline void check_plates() {
    const Mesh mesh = plates();
    const double odds = 13.815510557964274;
    const Wrench down{{0, 0, -10}, {0, 0, 0}};
    // By plate, the lowest first: its odds.
    const auto subject = [&](std::array<double, 3> bonus) {
        Subject s;
        s.mesh = mesh, s.noise = noise_of();
        for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
            const std::size_t plate = f / (mesh.faces.size() / 3);
            s.declared.bonus.push_back(bonus[plate]);
            s.declared.region.push_back(bonus[plate] != 0.0);
        }
        return s;
    };
    const auto height = [](const Answer& a) { return a.contact() ? a.contact()->point.z : -1.0; };
    const auto at = [&](const Answer& a, double z) { return std::fabs(height(a) - z) < 1e-6; };
    const double low = 0.002, middle = 0.014, top = 0.026;
    Subject plain = subject({0, 0, 0});
    Solver solver = plain.solver();
    Answer a = solver.locate(down);
    CHECK(a.reason == Reason::ambiguous && a.count == 3 && at(a, top));
    const double behind = std::exp(-0.5 * solver.gates().behind_cost);
    CHECK(close(a.confidence, 1.0 / (1.0 + 2.0 * behind), 1e-6));
    for (int i = 0; i < 3; ++i)
        CHECK(a.candidates[i].why == (i == a.chosen ? Why::chosen : Why::downstream));
    CHECK(contactbench::runner_up(a) && contactbench::runner_up(a)->point.z < top - 0.01);
    // The one touched last is it, without a doubt.
    for (const double z : {low, middle, top}) {
        const Vec3 previous{0.004, 0.004, z};
        a = solver.locate(down, &previous);
        CHECK(a.reason <= Reason::vertex && at(a, z) && a.confidence > 0.98);
    }
    const Vec3 beside{0.02, 0.0, middle};
    CHECK(solver.locate(down, &beside).reason == Reason::ambiguous);
    // A region decides, and says so; an untouchable plate leaves the others.
    Subject lowest = subject({odds, 0, 0});
    a = lowest.solver().locate(down);
    CHECK(a.reason == Reason::by_region && at(a, low) && a.contact()->region == 1 && a.confidence > 0.98);
    CHECK(contactbench::accepted(a.reason, lowest.gates));
    lowest.gates.accept_by_region = false;
    CHECK(!contactbench::accepted(a.reason, lowest.gates));
    Solver strict = lowest.solver();
    CHECK(strict.track(down).reason == Reason::by_region && strict.previous() == nullptr);
    lowest.gates.accept_by_region = true;
    Solver trusting = lowest.solver();
    CHECK(trusting.track(down).reason == Reason::by_region && trusting.previous() != nullptr);
    a = subject({0, 0, -odds}).solver().locate(down);
    CHECK(a.reason == Reason::ambiguous && at(a, middle));  // what cannot be touched hides nothing
    a = subject({-odds, 0, -odds}).solver().locate(down);
    CHECK(a.reason == Reason::by_region && at(a, middle));
    // Beside all plates, whatever was declared.
    const Wrench beyond{{0, 0, -10}, cross(Vec3{0.04, 0, 0}, Vec3{0, 0, -10})};
    a = lowest.solver().locate(beyond);
    CHECK(a.reason == Reason::implausible && !a.contact() && a.misfit > 100.0 && close(a.left_over, 0.15, 0.05));
    Subject only = subject({odds, 0, 0});
    only.gates.region_only = true;
    CHECK(only.solver().locate(down).reason == Reason::by_region);
    const Vec3 previous{0, 0, top};  // as likely as the region, and met first
    CHECK(only.solver().locate(down, &previous).reason == Reason::outside_region);
    CHECK(only.solver().locate({{0, 0, 10}, {0, 0, 0}}).reason == Reason::by_region);
    Subject none = subject({-odds, -odds, -odds});  // a number alone makes no region where touches are wanted
    CHECK(none.solver().locate(down).reason == Reason::ambiguous);
    none.gates.region_only = true;
    CHECK(none.solver().locate(down).reason == Reason::outside_region);
}

// A fin of 0.8 mm: touches on its edge are never sure and far off.
inline void check_fin() {
    Subject s;
    s.mesh = fin(), s.noise = noise_of();
    const Solver solver = s.solver();
    Random random(46);
    int sure = 0, off = 0;
    for (int i = 0; i < 600; ++i) {
        Touch touch;
        touch.point = {random.uniform(0.0, 0.0008), random.uniform(-0.014, 0.014), 0.04};
        touch.normal = {0, 0, 1};
        touch.force = random.uniform(5.0, 10.0) * Vec3{0.5 * random.normal(), 0.5 * random.normal(), -1.0};
        touch.torque = 3e-4 * norm(touch.force) * random.normal();
        Wrench w = touch.wrench();
        w.F = w.F + 0.05 * random.normal3();
        w.M = w.M + 0.002 * random.normal3();
        const Answer a = solver.locate(w);
        if (!contactbench::accepted(a.reason, s.gates)) continue;
        ++sure;
        off += norm(a.contact()->point - touch.point) > 0.01;
    }
    CHECK(sure > 60 && off * 50 < sure);
}

// A contact that wanders, jumps, is joined by another and lifts off, with samples that are late or broken.
struct Stream {
    Touch touch, other;
    bool joined = false;
    double age = 0.0;

    Wrench next(const Model& m, Random& random, double noise) {
        const auto event = random.below(400);
        if (event < 2) touch = random_touch(m, random, 1.2, event == 0 ? 0.1 : 0.01);
        if (event == 2) touch.force = 1e-3 * touch.force;
        if (event >= 3 && event < 6) touch.force = (10.0 / norm(touch.force)) * touch.force;
        if (event == 9 || event == 10) other = random_touch(m, random, 0.5, 0.01), joined = true;
        if (event > 10 && event < 14) joined = false;
        touch.point = touch.point + (0.003 * m.frame.scale) * random.normal3();
        touch.force = touch.force + (0.01 * norm(touch.force)) * random.normal3();
        Wrench w = touch.wrench();
        if (joined) w.F = w.F + other.wrench().F, w.M = w.M + other.wrench().M;
        w.F = w.F + 0.05 * noise * random.normal3();
        w.M = w.M + 0.002 * noise * random.normal3();
        if (event == 6) w.M.y = NAN;
        age = event == 7 || event == 8 ? 1.0 : 0.0;
        return w;
    }
};

inline WrenchCovariance twice(WrenchCovariance c) {
    for (auto& row : c.s)
        for (double& value : row) value *= 2.0;
    return c;
}

// What was accepted of a stream.
struct Moment {
    Wrench wrench;
    Candidate touch;
};

// A second touch is what the wrench has changed by since an accepted touch, which is still the first: lately, or, while
// two are told, the one that it was told by. -1: by none.
inline int moment_before(const Answer& a, const Wrench& w, const std::vector<Moment>& accepted, int told,
                         const Solver& doubled) {
    const Gates& g = doubled.gates();
    if (!a.has_second || a.chosen != 0 || contactbench::accepted(a.reason, g)) return -1;
    const int oldest = int(accepted.size()) - 6 * int(g.recent_samples);
    for (int i = int(accepted.size()) - 1; i >= 0; --i) {
        const Moment& before = accepted[std::size_t(i)];
        if ((i < oldest && i != told) || !same_bits(before.touch.point, a.candidates[0].point)) continue;
        const Wrench step{w.F - before.wrench.F, w.M - before.wrench.M};
        if (norm(step.F) < 2.0 * g.min_force) continue;
        const Answer alone = doubled.locate(step);
        const Candidate* c = alone.contact();
        if (!c || !same_bits(c->point, a.second.point)) continue;
        if (norm(c->point - before.touch.point) > 2.0 * g.follow_distance) return i;
    }
    return -1;
}

// track() is locate() with the last accepted contact, as long as that is recent, and with the arm that it tells; but where
// two touch it says so.
inline void check_tracking() {
    Random random(51);
    int twos = 0, grown = 0;
    for (const Mesh& mesh : zoo())
        for (const double noise : {1e-3, 1.0, 30.0}) {
            Subject s;
            s.mesh = mesh, s.noise = noise_of(noise), s.declared = Declared(mesh, random);
            s.gates.recent_samples = 5;
            s.learned = true;
            Solver solver = s.solver();
            const Solver doubled(s.model, twice(s.noise), s.arm, s.gates);
            Stream stream{random_touch(*s.model, random, 1.0, 0.01), {}};
            Vec3 last;
            std::vector<Moment> accepted;
            int told = -1;
            std::int64_t misses = s.gates.recent_samples + 1;
            for (int i = 0; i < 350; ++i) {
                const Wrench w = stream.next(*s.model, random, noise);
                const Vec3* previous = misses <= s.gates.recent_samples ? &last : nullptr;
                CHECK((solver.previous() == nullptr) == (previous == nullptr));
                if (previous && solver.previous()) CHECK(same_bits(*previous, *solver.previous()));
                Answer want;
                want.reason = Reason::stale;
                const Answer got = solver.track(w, stream.age, 0.002);
                if (stream.age == 0.0) want = solver.locate(w, previous, got.torsion_arm);
                grown += got.torsion_arm > 1.1 * s.arm;
                if (!previous) CHECK(!(got.torsion_arm > s.arm) && got.torsion_since == 0.0);
                ++misses;
                if (got.reason == Reason::two_touches) {
                    told = moment_before(got, w, accepted, told, doubled);
                    CHECK(told >= 0);
                    misses = 0;
                    ++twos;
                    continue;
                }
                CHECK(same_answer(want, got) && !got.has_second);
                if (!contactbench::followed(got.reason, s.gates)) continue;
                last = got.contact()->point, misses = 0;
                accepted.push_back({w, *got.contact()});
            }
            solver.reset();
            CHECK(solver.previous() == nullptr);
        }
    CHECK(twos > 50 && grown > 500);
}

// On a ball of 30 mm: first one touch, then another joins it.
inline void check_two_touches() {
    Subject s;
    s.mesh = sphere(4), s.noise = noise_of();
    Solver solver = s.solver();
    const auto press = [](Vec3 from, double force) {
        return Wrench{-force * from, {}};
    };
    const auto both = [](Wrench a, Wrench b) { return Wrench{a.F + b.F, a.M + b.M}; };
    const auto near = [](Vec3 p, Vec3 from) { return norm(p - 0.03 * from) < 0.002; };
    const Vec3 up{0, 0, 1}, side{std::sqrt(0.75), 0, 0.5};
    const Wrench first = press(up, 5.0), second = press(side, 4.0), together = both(first, second);
    const auto repeat = [&](Wrench w, int times) {
        Answer a;
        for (int i = 0; i < times; ++i) a = solver.track(w);
        return a;
    };
    const auto is_two = [&](const Answer& a) {
        return a.reason == Reason::two_touches && a.contact() && near(a.contact()->point, up) && a.has_second &&
               near(a.second.point, side);
    };
    const auto is_one = [&](const Answer& a, Vec3 from) {
        return contactbench::accepted(a.reason, s.gates) && !a.has_second && near(a.contact()->point, from);
    };
    // Both at once, from nothing: one wrench cannot tell.
    CHECK(!solver.track(together).has_second);
    solver.reset();
    // One, then both, as long as it lasts; then one again.
    CHECK(is_one(repeat(first, 50), up));
    for (int i = 0; i < 100; ++i) CHECK(is_two(solver.track(together)));
    CHECK(solver.previous() && near(*solver.previous(), up));
    CHECK(is_one(repeat(first, int(s.gates.recent_samples) + 2), up));
    CHECK(is_two(solver.track(together)));
    // Samples that say nothing change nothing.
    CHECK(solver.track(together, 1.0).reason == Reason::stale);
    CHECK(solver.track({{NAN, 0, 0}, {}}).reason == Reason::not_finite);
    CHECK(is_two(solver.track(together)));
    // The first leaves, and the second stays: from then on that is the touch.
    CHECK(is_one(repeat(second, 2 * int(s.gates.recent_samples) + 2), side));
    CHECK(!solver.track(second).has_second);
    // Nothing is remembered beyond lifting off, or a reset.
    CHECK(repeat({}, 1).reason == Reason::low_force);
    CHECK(!solver.track(together).has_second);
    solver.reset();
    repeat(first, 50);
    solver.reset();
    CHECK(!solver.track(together).has_second);
    // Pressing harder and sliding are one touch.
    solver.reset();
    for (int i = 0; i < 200; ++i) CHECK(!solver.track(press(up, 1.0 + 0.1 * i)).has_second);
    for (int i = 0; i < 300; ++i) {
        const double angle = 0.005 * i;  // 0.15 mm a sample
        CHECK(is_one(solver.track(press({std::sin(angle), 0, std::cos(angle)}, 5.0)), {std::sin(angle), 0, std::cos(angle)}));
    }
    // A touch that jumps takes its force along: that of the first is gone.
    solver.reset();
    CHECK(is_one(repeat(press(up, 5.0), 50), up));
    CHECK(is_one(repeat(press(side, 5.0), int(s.gates.recent_samples) + 2), side));
}

inline void check_gates() {
    Subject s;
    s.mesh = sphere(3), s.noise = noise_of();
    s.gates.saturation[2] = 50.0;
    Solver solver = s.solver();
    const Wrench good{{0, 0, -5}, {0, 0, 0}};
    const auto reason = [&](Wrench w, double age = 0.0) {
        const Answer a = solver.track(w, age);
        CHECK(contactbench::has_point(a.reason) == (a.chosen >= 0));
        return a.reason;
    };
    const auto sure = [&](Reason r) { return contactbench::accepted(r, s.gates); };
    CHECK(sure(reason(good)));
    for (const double bad : {double(NAN), HUGE_VAL, -HUGE_VAL}) {
        CHECK(reason({{bad, 0, -5}, {0, 0, 0}}) == Reason::not_finite);
        CHECK(reason({{0, 0, -5}, {0, bad, 0}}) == Reason::not_finite);
    }
    CHECK(reason({{0, 0, 0}, {0, 0, 0}}) == Reason::low_force);
    CHECK(reason({{0, 0, -0.49}, {0, 0, 0}}) == Reason::low_force);
    CHECK(reason({{0, 0, -50}, {0, 0, 0}}) == Reason::saturated);
    CHECK(reason({{0, 0, 50}, {0, 0, 0}}) == Reason::saturated);
    CHECK(reason({{1e200, 0, 0}, {0, 0, 0}}) == Reason::saturated);
    CHECK(reason(good, 0.2) == Reason::stale);
    CHECK(reason(good, NAN) == Reason::stale);
    CHECK(sure(reason(good, 0.1)));

    s = {};
    s.mesh = sphere(2), s.noise = noise_of();
    s.gates.min_force = 0.0;
    CHECK(s.solver().locate({}).reason == Reason::low_force);
    s.gates.region_only = true;
    CHECK(s.solver().locate(good).reason == Reason::outside_region);
    // However long a contact may be remembered, there is none before the first.
    s.gates.recent_samples = std::numeric_limits<std::int64_t>::max();
    CHECK(s.solver().previous() == nullptr);
    // Friction beyond the cone, an axis that passes far from the probe, a screw that no touch exerts, and a pull.
    s = {};
    s.mesh = sphere(4), s.noise = noise_of(0.3), s.arm = 1e-5;
    solver = s.solver();
    const Vec3 edge{0, 0, 0.03}, steep{9.9, 0, -1.2};
    CHECK(solver.locate({steep, cross(edge, steep)}).reason == Reason::tangential);
    s.gates.cos_friction = 0.1;  // 84 degrees
    CHECK(sure(s.solver().locate({steep, cross(edge, steep)}).reason));
    s = {};
    s.mesh = sphere(4), s.noise = noise_of();
    solver = s.solver();
    Random random(61);
    for (int i = 0; i < 500; ++i) {
        const Vec3 force = 10.0 * random.direction();
        Vec3 away = cross(force, random.direction());
        away = (0.12 / norm(away)) * away;
        const Answer a = solver.locate({force, cross(away, force) + 0.002 * random.normal3()});
        CHECK(a.reason == Reason::implausible && a.misfit > solver.gates().implausible_misfit);
        CHECK(a.left_over > 0.85 && a.left_over < 1.25);  // 90 mm beside the ball, 120 beside its middle; 10 N
        const Answer screw = solver.locate({force, 0.05 * force});
        CHECK(screw.reason == Reason::implausible && close(screw.arm, 0.05, 1e-9));
    }
    s.mesh = single();
    CHECK(s.solver().locate({{0, 0, 10}, {0, 0, 0}}).reason == Reason::off_surface);
}

// Vertices that no facet uses belong to no surface: they change no answer.
inline void check_unused_vertices() {
    Subject s;
    s.mesh = t_shape(3), s.noise = noise_of();
    const Solver plain = s.solver();
    s.mesh.vertices.push_back({0, 0, 100.0});
    const Solver near = s.solver();
    s.mesh.vertices.push_back({1e200, 0, 0});
    const Solver far = s.solver();
    Random random(62);
    for (int i = 0; i < 1000; ++i) {
        const Wrench w = random_touch(plain.model(), random, 0.6, 0.01).wrench();
        const Answer want = plain.locate(w);
        CHECK(same_answer(want, near.locate(w)) && same_answer(want, far.locate(w)));
    }
}

inline void check_memory() {
    Random random(71);
    for (const Mesh& mesh : {sphere(4), t_shape(4), plates()}) {
        Subject s;
        s.mesh = mesh, s.noise = noise_of(), s.declared = Declared(mesh, random);
        Solver solver = s.solver();
        Stream stream{random_touch(*s.model, random, 1.0, 0.01), {}};
        for (int i = 0; i < 1500; ++i) {
            const Wrench w = stream.next(*s.model, random, 1.0);
            const long before = allocations();
            const Answer a = solver.locate(w), b = solver.track(w, 0.0, 0.005);
            const Candidate* c = b.contact();
            if (c) (void)solver.covariance(w, c->point, c->normal, c->face, c->depth, b.torsion_arm);
            const long after = allocations();
            CHECK(after == before && a.count >= 0);
        }
    }
}

// The two methods that solve plane by plane, against the 4x4 system solved on every plane.
inline void check_closed_forms() {
    Random random(81);
    int found_some = 0;
    for (const Mesh& mesh : {sphere(2), t_shape(3), torus(24, 12), single(), two_pieces(2)}) {
        std::vector<std::int32_t> region(mesh.faces.size());
        for (std::int32_t& r : region) r = std::int32_t(random.below(3));
        const Model m = contactbench::make_model(mesh.vertices, mesh.faces, region);
        const contactbench::PlaneLoop loop(m);
        const contactbench::ScanTable table(m);
        const auto order = [](std::int32_t r) { return r > 0 ? r : 3; };
        for (int i = 0; i < 700; ++i) {
            const Wrench w = random_touch(m, random, 1.3, 0.02).wrench();
            const double cap = random.below(2) ? 0.2588 : 0.0;
            Candidate by_loop, by_table;
            const bool looped = loop.locate(w, by_loop), scanned = table.locate(m, w, cap, by_table);
            int first = 4, matches = 0, solutions = 0;
            double best = 0.0, best_torque = 0.0;
            Vec3 best_point;
            bool doubtful = false;
            for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
                const Vec3 n = cross(mesh.vertices[std::size_t(mesh.faces[f][1])] - mesh.vertices[std::size_t(mesh.faces[f][0])],
                                     mesh.vertices[std::size_t(mesh.faces[f][2])] - mesh.vertices[std::size_t(mesh.faces[f][0])]);
                const Vec3 normal = (1.0 / norm(n)) * n;
                const double cosine = -dot(normal, w.F) / norm(w.F);
                double x[4];
                if (!(cosine > 1e-9) || !solve_directly(w, normal, mesh.vertices[std::size_t(mesh.faces[f][0])], x)) continue;
                const Vec3 p{x[0], x[1], x[2]};
                const double least = least_weight(mesh, mesh.faces[f], normal, p);
                doubtful |= std::fabs(least) < 1e-9 || std::fabs(cosine - cap) < 1e-9;
                if (!(least > 0.0)) continue;
                ++solutions;
                first = std::min(first, int(order(region[f])));
                matches += looped && std::size_t(by_loop.face) == f && norm(by_loop.point - p) < 1e-9 &&
                           close(by_loop.torque, x[3], 1e-6, 1e-9);
                if (cosine >= cap && cosine > best) best = cosine, best_point = p, best_torque = x[3];
            }
            if (doubtful) continue;
            CHECK(looped == (solutions > 0));
            if (looped) CHECK(matches == 1 && order(by_loop.region) == first);
            CHECK(scanned == (best > 0.0));
            if (!scanned) continue;
            ++found_some;
            CHECK(close(by_table.cosine, best, 1e-9) && norm(by_table.point - best_point) < 1e-9);
            CHECK(close(by_table.torque, best_torque, 1e-6, 1e-9));
        }
    }
    CHECK(found_some > 2000);
    // Whole numbers: points exactly on edges and vertices, which belong to one facet each.
    const Mesh whole = subdivide(subdivide(octahedron()));
    const Model m = contactbench::make_model(whole.vertices, whole.faces, {});
    const contactbench::ScanTable table(m);
    for (int i = 0; i < 5000; ++i) {
        const Triangle& t = m.faces[random.below(m.normals.size())];
        const Vec3 p = 0.5 * (m.vertices[std::size_t(t[0])] + m.vertices[std::size_t(t[1])]);
        Vec3 f;
        do {
            f = {double(random.below(9)) - 4.0, double(random.below(9)) - 4.0, double(random.below(9)) - 4.0};
        } while (norm(f) == 0.0);
        bool both_push = true;
        for (std::size_t face = 0; face < m.normals.size(); ++face) {
            const Triangle& own = m.faces[face];
            const auto uses = [&](std::int32_t v) { return std::find(own.begin(), own.end(), v) != own.end(); };
            if (uses(t[0]) && uses(t[1])) both_push &= dot(m.normals[face], f) < -1e-9;
        }
        Candidate found;
        if (!both_push) continue;
        if (CHECK(table.locate(m, {f, cross(p, f)}, 0.0, found))) CHECK(norm(cross(found.point - p, f)) < 1e-12);
    }
}

inline void check_paraboloid() {
    Random random(91);
    for (int i = 0; i < 5000; ++i) {
        contactbench::Paraboloid s;
        s.axis[2] = random.direction();
        s.axis[0] = cross(s.axis[2], random.direction());
        s.axis[0] = (1.0 / norm(s.axis[0])) * s.axis[0];
        s.axis[1] = cross(s.axis[2], s.axis[0]);
        s.origin = 0.1 * random.normal3();
        const double fitted[6] = {0.001 * random.normal(), 0.05 * random.normal(), 0.05 * random.normal(),
                                  -random.uniform(2.0, 15.0), random.normal(), -random.uniform(2.0, 15.0)};
        std::copy(fitted, fitted + 6, s.c);
        const double x = random.uniform(-0.02, 0.02), y = random.uniform(-0.02, 0.02);
        const double* c = s.c;
        const double z = c[0] + c[1] * x + c[2] * y + c[3] * x * x + c[4] * x * y + c[5] * y * y;
        const Vec3 slope = -(c[1] + 2 * c[3] * x + c[4] * y) * s.axis[0] - (c[2] + c[4] * x + 2 * c[5] * y) * s.axis[1];
        Touch touch;
        touch.point = s.origin + (x * s.axis[0] + y * s.axis[1] + z * s.axis[2]);
        touch.normal = (1.0 / norm(slope + s.axis[2])) * (slope + s.axis[2]);
        Vec3 side = cross(touch.normal, random.direction());
        side = (1.0 / norm(side)) * side;
        const double angle = random.uniform(0.0, 0.6);
        touch.force = random.uniform(1.0, 20.0) * (-std::cos(angle) * touch.normal + std::sin(angle) * side);
        touch.torque = 1e-3 * random.normal();
        Candidate found;
        if (!CHECK(contactbench::locate_iteratively(s, touch.wrench(), found))) continue;
        CHECK(norm(found.point - touch.point) < 1e-8);
        CHECK(norm(found.normal - touch.normal) < 1e-6);
        CHECK(std::fabs(found.torque - touch.torque) < 1e-7);
        CHECK(!contactbench::locate_iteratively(s, {-touch.force, -touch.wrench().M}, found));
    }
}

inline void check_solver() {
    check_plates();
    check_fin();
    check_two_touches();
    check_gates();
    check_judgement();
    check_seams();
    check_tracking();
    check_unused_vertices();
    check_memory();
    check_closed_forms();
    check_paraboloid();
}

}  // namespace testing
