// Any bytes: a mesh and wrenches. The kernel refuses the mesh, or every method agrees on every wrench.
//
// With libFuzzer this is an ordinary target. For compilers without it the tests' program has it as well, and feeds it
// pseudo-random and mutated inputs instead:  test_kernel --fuzz [iterations] [seed]
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <vector>

#include "check.hpp"
#include "contactbench/algorithm1.hpp"
#include "contactbench/scan.hpp"
#include "contactbench/solver.hpp"

using namespace contactbench;

namespace {

[[noreturn]] void disagree(const char* what) {
    std::fprintf(stderr, "fuzz_kernel: %s\n", what);
    std::abort();
}

void require(bool ok, const char* what) {
    if (!ok) disagree(what);
}

// Bytes to numbers; past the end every byte is zero.
class Bytes {
public:
    Bytes(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}

    std::size_t left() const { return left_; }
    std::uint8_t byte() {
        if (left_ == 0) return 0;
        --left_;
        return *data_++;
    }
    // Mostly small multiples of 1/8, so that ties and degenerate facets are common; sometimes anything.
    double number() {
        const std::uint8_t b = byte();
        switch (b) {
            case 255: return NAN;
            case 254: return HUGE_VAL;
            case 253: return 1e300;
            case 252: return 1e-300;
            case 251:
            case 250: {
                std::uint64_t bits = 0;
                for (int i = 0; i < 8; ++i) bits = bits << 8 | byte();
                double value;
                std::memcpy(&value, &bits, sizeof value);
                return value;
            }
            case 249:
            case 248: return (double(byte()) - 128.0) * 1e-9;
            default: return (double(b) - 124.0) / (b % 5 == 0 ? 7.3 : 8.0);
        }
    }
    Vec3 vector() {
        const double x = number(), y = number();
        return {x, y, number()};
    }

private:
    const std::uint8_t* data_;
    std::size_t left_;
};

void check_candidate(const Candidate& c) {
    require(finite(c.point) && finite(c.normal), "a touch is not finite");
    require(c.face >= 0 && c.cosine > 0.0, "a touch without a facet or a push");
    require(c.misfit >= 0.0 && std::isfinite(c.cost()), "a touch without a cost");
}

void check_answer(const Answer& a) {
    require(has_point(a.reason) == (a.chosen >= 0), "a reason and its point disagree");
    require(a.count >= 0 && a.count <= Answer::capacity && a.chosen < a.count, "the chosen candidate does not exist");
    require(a.confidence >= 0.0 && a.confidence <= 1.0, "a confidence is no probability");
    require(a.has_second == (a.reason == Reason::two_touches), "a second touch without its reason");
    for (int i = 0; i < a.count; ++i) check_candidate(a.candidates[i]);
    if (a.has_second) check_candidate(a.second);
}

bool same_number(double a, double b) { return a == b || (a != a && b != b); }

bool same(const Answer& a, const Answer& b) {
    if (a.reason != b.reason || a.count != b.count || a.chosen != b.chosen) return false;
    for (int i = 0; i < a.count; ++i) {
        const Candidate &p = a.candidates[i], &q = b.candidates[i];
        if (p.face != q.face || p.vertex != q.vertex || p.cost() != q.cost() || p.why != q.why ||
            std::memcmp(&p.point, &q.point, sizeof p.point) != 0)
            return false;
    }
    return same_number(a.misfit, b.misfit) && same_number(a.left_over, b.left_over) && a.confidence == b.confidence;
}

// Facets whose normal is lost in the rounding of their corners are tested, but not compared: they
// have no normal to prune by.
bool well_shaped(const Model& m) {
    for (const Triangle& t : m.faces) {
        const auto at = [&](int c) { return m.normalised(t[std::size_t(c)]); };
        const Vec3 a = at(1) - at(0), b = at(2) - at(0), c = at(2) - at(1);
        const double longest = std::sqrt(std::fmax(norm2(a), std::fmax(norm2(b), norm2(c))));
        if (norm(cross(a, b)) < 1e-6 * longest) return false;
    }
    return true;
}

void check_wrench(Solver& solver, const ScanTable& table, const PlaneLoop& loop, const Wrench& w, double age,
                  bool compare) {
    const Vec3* previous = solver.previous();
    const Answer a = solver.locate(w, previous), b = solver.locate_exhaustively(w, previous);
    check_answer(a);
    check_answer(b);
    if (compare) require(same(a, b), "locate and locate_exhaustively differ");
    const Answer c = solver.track(w, age);
    check_answer(c);
    if (age > solver.gates().max_age)
        require(c.reason == Reason::stale, "an old sample was used");
    else if (c.reason != Reason::two_touches)
        require(same(a, c), "track and locate differ");
    if (gate(w, solver.gates()) != Reason::ok) return;
    Candidate found;
    if (table.locate(solver.model(), w, solver.gates().cos_friction, found))
        require(finite(found.point), "the table's point is not finite");
    if (loop.locate(w, found)) require(finite(found.point), "the plane loop's point is not finite");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Bytes bytes(data, size);
    const std::size_t vertex_count = bytes.byte() % 24, face_count = bytes.byte() % 48;
    const bool any_index = bytes.byte() % 16 == 0, regions = bytes.byte() % 2 == 0;
    std::vector<Vec3> vertices(vertex_count);
    for (Vec3& v : vertices) v = bytes.vector();
    std::vector<Triangle> faces(face_count);
    for (Triangle& t : faces)
        for (std::int32_t& v : t) {
            const std::int32_t b = bytes.byte();
            v = any_index ? b - 2 : vertex_count > 0 ? b % std::int32_t(vertex_count) : b;
        }
    // Refusing is right, but says nothing about the search: mostly drop what is refused for sure.
    if (!any_index)
        std::erase_if(faces, [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
    std::vector<std::int32_t> region(regions ? faces.size() : bytes.byte() % 4 == 0);
    for (std::int32_t& r : region) r = bytes.byte() % 3;
    Gates gates;
    gates.min_force = bytes.byte() % 2 ? 0.5 : 0.0;
    gates.region_only = bytes.byte() % 8 == 0;
    gates.recent_samples = bytes.byte() % 4;
    gates.cos_friction = double(bytes.byte() % 8) / 8.0;
    gates.ambiguity_distance = double(bytes.byte() % 8) * 0.05;
    gates.follow_distance = double(bytes.byte() % 8) * 0.1;
    gates.rival_cost = double(bytes.byte() % 16);
    gates.accept_by_region = bytes.byte() % 2 == 0;
    gates.sigma_max = double(bytes.byte() % 4) * 0.02;
    const double arm = double(bytes.byte() % 16) * double(bytes.byte() % 4) * 1e-3;
    const MeshTerms terms{double(bytes.byte() % 4) * 1e-3, bytes.byte() % 2 == 0};
    std::vector<double> bonus(bytes.byte() % 2 ? faces.size() : 0);
    for (double& b : bonus) b = bytes.byte() % 4 ? 0.0 : double(bytes.byte()) / 8.0 - 16.0;
    WrenchCovariance noise;
    const double level = double(bytes.byte()) * 1e-4;
    for (int i = 0; i < 6; ++i) noise.s[i][i] = level * level * (1.0 + bytes.byte() % 8);
    for (int i = 0; i < 3; ++i) noise.s[i][i + 3] = noise.s[i + 3][i] = 0.5 * level * level;
    std::shared_ptr<const Model> model;
    try {
        model = std::make_shared<const Model>(make_model(std::move(vertices), faces, std::move(region), bonus, terms));
    } catch (const std::invalid_argument&) {
        return 0;
    }
    Solver solver(model, noise, arm, gates);
    const ScanTable table(*model);
    const PlaneLoop loop(*model);
    const bool compare = well_shaped(*model);
    for (int i = 0; i < 16 && bytes.left() > 0; ++i) {
        Wrench w{bytes.vector(), bytes.vector()};
        // Half of them are touches: moments of random forces mostly miss.
        const std::uint8_t kind = bytes.byte();
        const Vec3 on = model->vertices[std::size_t(faces[kind % faces.size()][kind % 3])];
        if (kind % 2 == 0) w.M = cross(on, w.F) + (kind % 4 == 0 ? 0.01 : 0.0) * w.M;
        check_wrench(solver, table, loop, w, kind % 32 == 1 ? 1.0 : 0.0, compare);
    }
    return 0;
}

int fuzz(int argc, char** argv) {
    const long iterations = argc > 2 ? std::atol(argv[2]) : 10000;
    testing::Random random(argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 1);
    std::vector<std::uint8_t> input;
    for (long i = 0; i < iterations; ++i) {
        // Four in five change a few bytes of the last one: neighbours of an accepted mesh are near it.
        if (input.empty() || random.below(5) == 0) {
            input.resize(random.below(700));
            const bool tame = random.below(2) == 0;  // no special numbers
            for (std::uint8_t& b : input) b = std::uint8_t(random.below(tame ? 248 : 256));
        } else {
            for (std::size_t n = random.below(6); n > 0; --n) {
                input[random.below(input.size())] = std::uint8_t(random.bits());
            }
        }
        if (input.empty()) input.push_back(0);
        LLVMFuzzerTestOneInput(input.data(), input.size());
    }
    std::printf("%ld inputs fuzzed\n", iterations);
    return 0;
}
