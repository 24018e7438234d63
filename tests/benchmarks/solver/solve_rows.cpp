// Solves the wrenches of a file with the kernel's own headers and writes every answer: solve_rows IN OUT
//
// Built by bits.py with one compiler and set of options after another, so that the bits can be compared.
//
// IN   int64 vertices, facets, wrenches; double covariance[36], min_force, cos_friction,
//      implausible_misfit, rival_cost, ambiguity_distance, behind_cost, behind_distance, follow_cost, follow_distance,
//      depth_distance, torsion_arm, mesh_deviation, mesh_curved; double vertices[][3]; int32 facets[][3];
//      double wrenches[][6]
// OUT  a Row for each wrench, each solved on its own; then a Row for each, tracked as one stream
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>
#if defined(__AVX__)
#include <immintrin.h>
#endif

using Wide = double;  // what files hold, whatever the solver computes with

#include "contactbench/solver.hpp"

namespace {

using Real = double;

struct Row {
    std::int32_t reason, face, vertex, candidates;
    Wide point[3], normal[3], torque, covariance[9];
};

struct Header {
    std::int64_t vertices, facets, wrenches;
    Wide covariance[36], min_force, cos_friction, implausible_misfit, rival_cost, ambiguity_distance, behind_cost,
        behind_distance, follow_cost, follow_distance, depth_distance, torsion_arm, mesh_deviation, mesh_curved;
};

template <class T>
std::vector<T> read(std::FILE* file, std::size_t count) {
    std::vector<T> values(count);
    if (std::fread(values.data(), sizeof(T), count, file) != count) throw std::runtime_error("the file is too short");
    return values;
}

contactbench::Vec3 vector(const Wide* v) { return {Real(v[0]), Real(v[1]), Real(v[2])}; }

Row row(const contactbench::Answer& a, const contactbench::Solver& solver, const contactbench::Wrench& w) {
    Row r;
    r.reason = std::int32_t(a.reason), r.candidates = a.count;
    r.face = r.vertex = -1;
    const Wide nan = std::numeric_limits<Wide>::quiet_NaN();
    std::fill(r.point, r.point + 3, nan), std::fill(r.normal, r.normal + 3, nan);
    std::fill(r.covariance, r.covariance + 9, nan), r.torque = nan;
    if (a.chosen < 0) return r;
    const contactbench::Candidate& c = a.candidates[a.chosen];
    r.face = c.face, r.vertex = c.vertex, r.torque = c.torque;
    const Real point[3] = {c.point.x, c.point.y, c.point.z}, normal[3] = {c.normal.x, c.normal.y, c.normal.z};
    std::copy(point, point + 3, r.point), std::copy(normal, normal + 3, r.normal);
    if (!contactbench::has_point(a.reason)) return r;
    const contactbench::Mat3 s = solver.covariance(w, c.point, c.normal, c.face, c.depth, solver.torsion().arm);
    std::copy(&s.m[0][0], &s.m[0][0] + 9, r.covariance);
    return r;
}

void solve(const char* in, const char* out) {
    std::FILE* file = std::fopen(in, "rb");
    if (!file) throw std::runtime_error("cannot open the input");
    const Header h = read<Header>(file, 1)[0];
    const auto points = read<Wide>(file, std::size_t(3 * h.vertices));
    const auto corners = read<std::int32_t>(file, std::size_t(3 * h.facets));
    const auto wrenches = read<Wide>(file, std::size_t(6 * h.wrenches));
    std::fclose(file);

    std::vector<contactbench::Vec3> vertices;
    for (std::size_t i = 0; i < points.size(); i += 3) vertices.push_back(vector(&points[i]));
    std::vector<contactbench::Triangle> faces;
    for (std::size_t i = 0; i < corners.size(); i += 3) faces.push_back({corners[i], corners[i + 1], corners[i + 2]});
    contactbench::WrenchCovariance noise;
    for (int i = 0; i < 36; ++i) noise.s[i / 6][i % 6] = Real(h.covariance[i]);
    contactbench::Gates gates;
    gates.min_force = Real(h.min_force), gates.cos_friction = Real(h.cos_friction);
    gates.implausible_misfit = Real(h.implausible_misfit), gates.rival_cost = Real(h.rival_cost);
    gates.ambiguity_distance = Real(h.ambiguity_distance);
    gates.behind_cost = Real(h.behind_cost), gates.behind_distance = Real(h.behind_distance);
    gates.follow_cost = Real(h.follow_cost), gates.follow_distance = Real(h.follow_distance);
    gates.depth_distance = Real(h.depth_distance);
    const contactbench::MeshTerms terms{Real(h.mesh_deviation), h.mesh_curved != 0};
    const auto model =
        std::make_shared<const contactbench::Model>(contactbench::make_model(vertices, faces, {}, {}, terms));
    contactbench::Solver solver(model, noise, Real(h.torsion_arm), gates);

    std::vector<Row> rows;
    const auto each = [&](auto&& answer) {
        for (std::size_t i = 0; i < wrenches.size(); i += 6) {
            const contactbench::Wrench w{vector(&wrenches[i]), vector(&wrenches[i + 3])};
            rows.push_back(row(answer(w), solver, w));
        }
    };
    each([&](const contactbench::Wrench& w) { return solver.locate(w); });
    each([&](const contactbench::Wrench& w) { return solver.track(w); });
    file = std::fopen(out, "wb");
    if (!file || std::fwrite(rows.data(), sizeof(Row), rows.size(), file) != rows.size() || std::fclose(file) != 0)
        throw std::runtime_error("cannot write the output");
}

}  // namespace

int main(int count, char** arguments) {
    try {
        if (count != 3) throw std::runtime_error("usage: solve_rows IN OUT");
        solve(arguments[1], arguments[2]);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "solve_rows: %s\n", error.what());
        return 2;
    }
}
