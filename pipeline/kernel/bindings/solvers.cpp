// The solver, its rivals, and batches of answers.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>

#include "bindings.hpp"

namespace contactbench::bindings {

namespace {

// ---- rows on several cores -------------------------------------------------------------------

// Rows that a thread takes at a time: some milliseconds at most, so that all end together, and far more than what
// taking them costs.
constexpr std::size_t stretch = 256;

// Calls `work(row)` for every row, on as many threads as are asked for (0: one a core). Rows must not know of each other;
// `work` must not throw. The result does not depend on who did which row.
template <class Work>
void each_row(std::size_t rows, unsigned threads, const Work& work) {
    std::atomic<std::size_t> next{0};
    const auto take = [&] {
        for (std::size_t from; (from = next.fetch_add(stretch)) < rows;)
            for (std::size_t i = from, to = std::min(from + stretch, rows); i < to; ++i) work(i);
    };
    const unsigned wanted = threads ? threads : std::max(1u, std::thread::hardware_concurrency());
    const std::size_t most = std::min<std::size_t>(wanted, (rows + stretch - 1) / stretch);
    std::vector<std::thread> others;
    try {
        while (others.size() + 1 < most) others.emplace_back(take);
    } catch (const std::system_error&) {
        // No more threads are to be had: those that are here do it all.
    }
    take();
    for (std::thread& each : others) each.join();
}

// ---- answers, many at once -------------------------------------------------------------------

struct Rows {
    explicit Rows(std::size_t n)
        : points(3 * n), normals(3 * n), forces(3 * n), moments(3 * n), previous(3 * n, nan), seconds(3 * n),
          depths(n), torques(n), misfits(n), left_overs(n), arms(n), torsion_arms(n), confidences(n), faces(n), vertices(n),
          candidates(n),
          regions(n), reasons(n) {}

    void set(std::size_t i, const Wrench& w, const Answer& a) {
        Candidate c;
        c.point = c.normal = {nan, nan, nan};
        c.torque = nan;
        if (a.contact()) c = *a.contact();
        put(seconds, i, a.has_second ? a.second.point : Vec3{nan, nan, nan});
        misfits[i] = a.misfit, left_overs[i] = a.left_over, arms[i] = a.arm, confidences[i] = a.confidence;
        torsion_arms[i] = a.torsion_arm;
        put(points, i, c.point), put(normals, i, c.normal), put(forces, i, w.F), put(moments, i, w.M);
        depths[i] = c.depth, torques[i] = c.torque;
        faces[i] = c.face, vertices[i] = c.vertex, regions[i] = c.region;
        candidates[i] = a.count;
        reasons[i] = std::uint8_t(a.reason);
    }

    static void put(std::vector<double>& to, std::size_t i, Vec3 v) {
        to[3 * i] = v.x, to[3 * i + 1] = v.y, to[3 * i + 2] = v.z;
    }
    static Vec3 get(const std::vector<double>& from, std::size_t i) { return three(from.data() + 3 * i); }

    static constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    std::vector<double> points, normals, forces, moments, previous, seconds;
    std::vector<double> depths, torques, misfits, left_overs, arms, torsion_arms, confidences;
    std::vector<std::int32_t> faces, vertices, candidates, regions;
    std::vector<std::uint8_t> reasons;
};

using Seconds = nb::ndarray<const double, nb::shape<-1>, nb::c_contig, nb::device::cpu>;

struct Batch {
    std::shared_ptr<const Solver> context;
    std::shared_ptr<Rows> rows;
    bool complete = false;  // of the solver itself: a row can be located again, with its candidates
    unsigned threads = 1;

    std::size_t size() const { return rows->torques.size(); }
};

template <class T>
nb::object view(const Batch& b, std::vector<T> Rows::*member, std::initializer_list<std::size_t> shape) {
    // The array keeps the rows alive, not the batch object.
    nb::capsule owner(new std::shared_ptr<Rows>(b.rows),
                      [](void* p) noexcept { delete static_cast<std::shared_ptr<Rows>*>(p); });
    return nb::cast(nb::ndarray<nb::numpy, const T>((*b.rows.*member).data(), shape.size(), shape.begin(), owner));
}

// A row with everything there is to know: candidates are not kept, but a locate is pure and gives them again.
Contact row_contact(const Batch& b, std::size_t i) {
    const Rows& rows = *b.rows;
    Contact c{b.context, {Rows::get(rows.forces, i), Rows::get(rows.moments, i)}, {}};
    Answer& a = c.answer;
    const Reason reason = Reason(rows.reasons[i]);
    if (b.complete && reason != Reason::stale) {
        const Vec3 previous = Rows::get(rows.previous, i);
        a = b.context->locate(c.wrench, finite(previous) ? &previous : nullptr, rows.torsion_arms[i]);
    }
    a.reason = reason;
    a.misfit = rows.misfits[i], a.left_over = rows.left_overs[i], a.arm = rows.arms[i];
    a.torsion_arm = rows.torsion_arms[i], a.confidence = rows.confidences[i];
    if (!has_point(reason)) return c;
    if (b.complete && reason != Reason::two_touches) return c;
    Candidate& k = a.candidates[0] = Candidate{};
    k.point = Rows::get(rows.points, i), k.normal = Rows::get(rows.normals, i);
    k.depth = rows.depths[i], k.torque = rows.torques[i];
    k.misfit = rows.misfits[i];
    k.cosine = -dot(k.normal, c.wrench.F) / norm(c.wrench.F);
    k.face = rows.faces[i], k.vertex = rows.vertices[i];
    k.region = rows.regions[i];
    k.why = Why::chosen;
    a.count = std::max(a.count, 1), a.chosen = 0;
    a.second.point = Rows::get(rows.seconds, i);
    a.has_second = finite(a.second.point);
    return c;
}

// Calls `use(row, covariance)` for every row that has a point, without the interpreter's lock.
template <class Use>
void visit_covariances(const Batch& b, Use&& use) {
    nb::gil_scoped_release release;
    each_row(b.size(), b.threads, [&](std::size_t i) {
        if (!has_point(Reason(b.rows->reasons[i]))) return;
        const Rows& r = *b.rows;
        const Wrench w{Rows::get(r.forces, i), Rows::get(r.moments, i)};
        const Vec3 point = Rows::get(r.points, i), normal = Rows::get(r.normals, i);
        use(i, b.context->covariance(w, point, normal, r.faces[i], r.depths[i], r.torsion_arms[i]));
    });
}

nb::object batch_covariances(const Batch& b) {
    std::vector<double> out(9 * b.size(), std::numeric_limits<double>::quiet_NaN());
    visit_covariances(b, [&](std::size_t i, const Mat3& s) {
        std::copy(&s.m[0][0], &s.m[0][0] + 9, out.begin() + std::ptrdiff_t(9 * i));
    });
    return make_array(std::move(out), {b.size(), 3, 3});
}

nb::object batch_sigma_max(const Batch& b) {
    std::vector<double> out(b.size(), std::numeric_limits<double>::quiet_NaN());
    visit_covariances(b, [&](std::size_t i, const Mat3& s) { out[i] = largest_sigma(s); });
    return make_array(std::move(out), {b.size()});
}

// ---- methods: each has solve(wrench) -> Answer and a context ----------------------------------

struct Main {
    std::shared_ptr<const Solver> context;
    Solver live;  // shares the model; holds the tracker
    std::mutex busy;  // guards `live`: batches run without the interpreter's lock
    Answer solve(const Wrench& w) const { return context->locate(w); }
};

// A rival that knows one answer and no doubt: the gates are the same, the reason is ok, uncertain or off_surface.
template <class Find>
Answer only_answer(const Solver& context, const Wrench& w, Find&& find) {
    Answer a;
    a.reason = gate(w, context.gates());
    if (a.reason != Reason::ok) return a;
    a.torsion_arm = context.torsion().arm;
    Candidate c;
    a.reason = Reason::off_surface;
    if (!find(c)) return a;
    c.why = Why::chosen;
    a.candidates[0] = c;
    a.count = 1;
    a.chosen = 0;
    a.reason = context.asked_near(w, c, Reason::ok);
    a.confidence = 1.0;
    return a;
}

struct Scan {
    std::shared_ptr<const Solver> context;
    ScanTable table;
    explicit Scan(const Main& m) : context(m.context), table(m.context->model()) {}
    Answer solve(const Wrench& w) const {
        return only_answer(*context, w, [&](Candidate& c) {
            return table.locate(context->model(), w, context->gates().cos_friction, c);
        });
    }
};

struct Algorithm1 {
    std::shared_ptr<const Solver> context;
    PlaneLoop loop;
    explicit Algorithm1(const Main& m) : context(m.context), loop(m.context->model()) {}
    Answer solve(const Wrench& w) const {
        return only_answer(*context, w, [&](Candidate& c) { return loop.locate(w, c); });
    }
};

struct Iterative {
    std::shared_ptr<const Solver> context;
    Paraboloid surface;
    Answer solve(const Wrench& w) const {
        return only_answer(*context, w, [&](Candidate& c) { return locate_iteratively(surface, w, c); });
    }
};

// Of rows: what they are sorted by, and their numbers.
using Order = std::vector<std::pair<std::uint64_t, std::size_t>>;

// Rows (n, 6), those whose lines of force lie side by side one after the other: they look at the same part of a tree, which is
// then at hand.
Order side_by_side(const Frame& frame, const double* rows, std::size_t n) {
    Order order(n);
    for (std::size_t i = 0; i < n; ++i) {
        const Wrench w = to_wrench(rows + 6 * i);
        const double per_force = 1.0 / norm(w.F);
        const Vec3 f = per_force * w.F, m = (per_force / frame.scale) * (w.M - cross(frame.centre, w.F)), foot = cross(f, m);
        std::uint64_t key = 0;
        // Bit by bit of 64 steps from -1 to 1, the coarsest of all six first.
        for (int bit = 5; bit >= 0; --bit)
            for (const double x : {f.x, f.y, f.z, foot.x, foot.y, foot.z})
                key = 2 * key + (unsigned(std::clamp(std::isfinite(x) ? x : 0.0, -1.0, 0.999) * 32.0 + 32.0) >> bit & 1u);
        order[i] = {key, i};
    }
    std::sort(order.begin(), order.end());
    return order;
}

// Rows that know nothing of each other, on several threads.
template <class Method, class Solve>
Batch solve_rows(const std::shared_ptr<const Solver>& context, const Rows6& wrenches, unsigned threads, Solve&& solve) {
    Batch b{context, std::make_shared<Rows>(wrenches.shape(0)), std::is_same_v<Method, Main>, threads};
    const double* data = wrenches.data();
    nb::gil_scoped_release release;
    Order order;
    if (b.complete && context->model().tree.large()) order = side_by_side(context->model().frame, data, b.size());
    each_row(b.size(), threads, [&](std::size_t nth) {
        const std::size_t i = order.empty() ? nth : order[nth].second;
        const Wrench w = to_wrench(data + 6 * i);
        b.rows->set(i, w, solve(i, w, *b.rows));
    });
    return b;
}

// Rows of one stream, in their order.
template <class Solve>
Batch track_rows(Main& s, const Rows6& wrenches, Solve&& solve) {
    const std::size_t n = wrenches.shape(0);
    Batch b{s.context, std::make_shared<Rows>(n), true};
    const double* data = wrenches.data();
    nb::gil_scoped_release release;
    // Taken without the interpreter's lock and given back before it is asked for again: no deadlock.
    const std::lock_guard lock(s.busy);
    for (std::size_t i = 0; i < n; ++i) {
        const Wrench w = to_wrench(data + 6 * i);
        if (const Vec3* p = s.live.previous()) Rows::put(b.rows->previous, i, *p);
        b.rows->set(i, w, solve(i, w));
    }
    return b;
}

// For the speed study's percentiles.
template <class Solve>
nb::object time_rows(const Rows6& wrenches, Solve&& solve) {
    const double* data = wrenches.data();
    return time_calls(wrenches.shape(0), [&](std::size_t i) { return solve(to_wrench(data + 6 * i)).chosen; });
}

template <class Method>
void bind_method(nb::class_<Method>& c) {
    c.def("locate", [](const Method& m, Vector6 w) {
        const Wrench wrench = to_wrench(w.data());
        return Contact{m.context, wrench, m.solve(wrench)};
    }, nb::arg("wrench"), "Locate the contact of one wrench (6,): Fx Fy Fz Mx My Mz in S, N and N·m.");
    c.def("locate", [](const Method& m, nb::handle w) {
        const Wrench wrench = to_wrench(w);
        return Contact{m.context, wrench, m.solve(wrench)};
    }, nb::arg("wrench"));
    c.def("locate_batch", [](const Method& m, nb::handle rows, unsigned threads) {
        return solve_rows<Method>(m.context, to_rows(rows), threads,
                                  [&](std::size_t, const Wrench& w, Rows&) { return m.solve(w); });
    }, nb::arg("wrenches").none(), nb::arg("threads") = 1,
       "Locate each row of (n, 6) on its own, without the interpreter's lock, on so many threads; 0: one a core. The"
       " answers are the same to the bit.");
    c.def("time_each", [](const Method& m, nb::handle rows) {
        return time_rows(to_rows(rows), [&](const Wrench& w) { return m.solve(w); });
    }, nb::arg("wrenches"), "Nanoseconds of each compiled solve (n,).");
}

// ---- construction -----------------------------------------------------------------------------

void construct(Main* self, Rows3 vertices, Faces faces, Ints region, Matrix6 noise, Bonus bonus, double torsion_arm,
               bool torsion_learned, double mesh_deviation, bool mesh_curved, Gates gates) {
    WrenchCovariance s;
    std::copy(noise.data(), noise.data() + 36, &s.s[0][0]);
    for (const auto& row : s.s)
        for (const double value : row)
            if (!std::isfinite(value)) throw std::invalid_argument("the noise covariance is not finite");
    if (!(torsion_arm >= 0.0) || !(torsion_arm <= 1e3)) throw std::invalid_argument("the torsion arm is not a length");
    auto model = to_model(vertices, faces, region, bonus, mesh_deviation, mesh_curved);
    auto context = std::make_shared<const Solver>(std::move(model), s, Torsion{torsion_arm, torsion_learned}, gates);
    new (self) Main{context, *context, {}};
}

// Contacts that a method outside the kernel worked out, in the same wrapping; face < 0: it found none.
Batch foreign_batch(const Main& m, nb::handle wrenches, Rows3 points, Ints faces,
                    nb::ndarray<const double, nb::shape<-1>, nb::c_contig, nb::device::cpu> torques) {
    const Rows6 rows = to_rows(wrenches);
    const std::size_t n = rows.shape(0);
    if (points.shape(0) != n || faces.shape(0) != n || torques.shape(0) != n)
        throw nb::value_error("points, faces and torques must have one row per wrench");
    const auto& model = m.context->model();
    // A copy: the array may change while the interpreter's lock is given up.
    const std::vector<std::int32_t> checked(faces.data(), faces.data() + n);
    for (const std::int32_t face : checked)
        if (face >= std::int32_t(model.normals.size())) throw nb::index_error("face number out of range");
    return solve_rows<void>(m.context, rows, 1, [&](std::size_t i, const Wrench& w, Rows&) {
        return only_answer(*m.context, w, [&](Candidate& c) {
            const std::int32_t face = checked[i];
            if (face < 0) return false;
            c.point = three(points.data() + 3 * i);
            c.normal = model.normals[std::size_t(face)];
            c.face = face;
            c.region = model.region(face);
            c.torque = torques.data()[i];
            c.cosine = -dot(c.normal, w.F) / norm(w.F);
            return true;
        });
    });
}

bool same(const Answer& a, const Answer& b) {
    bool equal = a.reason == b.reason && a.count == b.count && a.chosen == b.chosen;
    for (std::int32_t i = 0; equal && i < a.count; ++i) {
        const Candidate &x = a.candidates[i], &y = b.candidates[i];
        equal = x.face == y.face && x.vertex == y.vertex && x.misfit == y.misfit && norm2(x.point - y.point) == 0.0;
    }
    return equal && (a.misfit == b.misfit || (std::isnan(a.misfit) && std::isnan(b.misfit))) &&
           a.confidence == b.confidence;
}

nb::object search_differences(const Main& m, nb::handle wrenches, nb::handle previous) {
    const Rows6 rows = to_rows(wrenches);
    const std::size_t n = rows.shape(0);
    const double* data = rows.data();
    Vector3 given;
    const bool follows = !previous.is_none();
    if (follows && !nb::try_cast(previous, given)) throw nb::type_error("previous must be three float64 numbers or None");
    const Vec3 last = follows ? three(given.data()) : Vec3{};
    std::vector<std::int64_t> differ;
    {
        nb::gil_scoped_release release;
        for (std::size_t i = 0; i < n; ++i) {
            const Wrench w = to_wrench(data + 6 * i);
            if (!same(m.context->locate(w, follows ? &last : nullptr),
                      m.context->locate_exhaustively(w, follows ? &last : nullptr)))
                differ.push_back(std::int64_t(i));
        }
    }
    return make_array(std::move(differ));
}

void bind_batch(nb::module_& m) {
    nb::class_<Batch>(m, "Batch", "Answers to many wrenches, one row each; NaN and -1 where there is none.")
        .def("__len__", &Batch::size)
        .def("__getitem__", [](const Batch& b, std::int64_t i) {
            if (i < 0) i += std::int64_t(b.size());
            if (i < 0 || i >= std::int64_t(b.size())) throw nb::index_error("row out of range");
            return row_contact(b, std::size_t(i));
        }, nb::arg("row"), "One row as a Contact; candidates that lost are worked out again.")
        .def_prop_ro("points", [](const Batch& b) { return view(b, &Rows::points, {b.size(), 3}); }, "(n, 3) S, m.")
        .def_prop_ro("normals", [](const Batch& b) { return view(b, &Rows::normals, {b.size(), 3}); }, "(n, 3) S.")
        .def_prop_ro("torques", [](const Batch& b) { return view(b, &Rows::torques, {b.size()}); }, "(n,) k, N·m.")
        .def_prop_ro("misfits", [](const Batch& b) { return view(b, &Rows::misfits, {b.size()}); },
                     "(n,) d2 of the best touch, standard deviations squared; also where there is no point.")
        .def_prop_ro("left_overs", [](const Batch& b) { return view(b, &Rows::left_overs, {b.size()}); },
                     "(n,) torque that it does not explain, N·m.")
        .def_prop_ro("arms", [](const Batch& b) { return view(b, &Rows::arms, {b.size()}); },
                     "(n,) torque along the force over the force, m.")
        .def_prop_ro("torsion_arms", [](const Batch& b) { return view(b, &Rows::torsion_arms, {b.size()}); },
                     "(n,) m: torsion over force, 1 sigma, that each row was judged by.")
        .def_prop_ro("confidences", [](const Batch& b) { return view(b, &Rows::confidences, {b.size()}); }, "(n,) 0 to 1, no probabilities.")
        .def_prop_ro("seconds", [](const Batch& b) { return view(b, &Rows::seconds, {b.size(), 3}); },
                     "(n, 3) S, m: a touch that joined the one that is followed.")
        .def_prop_ro("accepted", [](const Batch& b) {
            bool* flags = new bool[b.size() + 1];
            for (std::size_t i = 0; i < b.size(); ++i) flags[i] = accepted(Reason(b.rows->reasons[i]), b.context->gates());
            nb::capsule owner(flags, [](void* p) noexcept { delete[] static_cast<bool*>(p); });
            const std::size_t shape[1] = {b.size()};
            return nb::cast(nb::ndarray<nb::numpy, bool>(flags, 1, shape, owner));
        }, "(n,) bool: safe to act on.")
        .def_prop_ro("faces", [](const Batch& b) { return view(b, &Rows::faces, {b.size()}); }, "(n,) int32.")
        .def_prop_ro("vertices", [](const Batch& b) { return view(b, &Rows::vertices, {b.size()}); }, "(n,) int32.")
        .def_prop_ro("reasons", [](const Batch& b) { return view(b, &Rows::reasons, {b.size()}); }, "(n,) uint8, see Reason.")
        .def_prop_ro("candidates", [](const Batch& b) { return view(b, &Rows::candidates, {b.size()}); },
                     "(n,) int32: how many candidates there were, the chosen one included.")
        .def_prop_ro("covariances", &batch_covariances, "(n, 3, 3) S, m²; worked out at each access.")
        .def_prop_ro("sigma_max", &batch_sigma_max, "(n,) m: largest standard deviation of each point.");
}

void bind_main(nb::module_& m) {
    auto solver = nb::class_<Main>(m, "Solver", "The pruned, complete solver over one mesh.");
    solver.def("__init__", [](Main* self, Rows3 vertices, Faces faces, Ints region, Matrix6 noise, Bonus bonus,
                              double torsion_arm, bool torsion_learned, double mesh_deviation, bool mesh_curved,
                              const nb::dict& gates) {
        construct(self, vertices, faces, region, noise, bonus, torsion_arm, torsion_learned, mesh_deviation, mesh_curved,
                  to_gates(gates));
    }, nb::arg("vertices"), nb::arg("faces").noconvert(), nb::arg("region").noconvert(), nb::arg("noise"), nb::kw_only(),
       nb::arg("bonus"), nb::arg("torsion_arm"), nb::arg("torsion_learned") = false, nb::arg("mesh_deviation"),
       nb::arg("mesh_curved"), nb::arg("gates"));
    bind_method(solver);
    solver.def("locate", [](const Main& s, nb::handle w, nb::handle previous) {
        const Wrench wrench = to_wrench(w);
        Vector3 given;
        if (previous.is_none()) return Contact{s.context, wrench, s.context->locate(wrench)};
        if (!nb::try_cast(previous, given))
            throw nb::type_error("previous must be the point of a contact: three float64 numbers, S, m, or None");
        const Vec3 p = three(given.data());
        return Contact{s.context, wrench, s.context->locate(wrench, &p)};
    }, nb::arg("wrench"), nb::arg("previous").none(),
       "The same, with the last accepted contact point (3,), S, m, or None.");
    solver.def("locate_batch_after", [](const Main& s, nb::handle wrenches, Rows3 previous, unsigned threads) {
        const Rows6 rows = to_rows(wrenches);
        if (previous.shape(0) != rows.shape(0)) throw nb::value_error("previous must have one row per wrench");
        const double* p = previous.data();
        return solve_rows<Main>(s.context, rows, threads, [&](std::size_t i, const Wrench& w, Rows& out) {
            const Vec3 point = three(p + 3 * i);
            Rows::put(out.previous, i, point);
            return s.context->locate(w, finite(point) ? &point : nullptr);
        });
    }, nb::arg("wrenches"), nb::arg("previous"), nb::arg("threads") = 1,
       "Locate each row given the contact (n, 3) accepted before it, S, m; NaN for none.");
    solver.def("track", [](Main& s, Vector6 w) {
        const Wrench wrench = to_wrench(w.data());
        const std::lock_guard lock(s.busy);
        return Contact{s.context, wrench, s.live.track(wrench)};
    }, nb::arg("wrench"), "The next sample of one stream: equal to locate with the last accepted contact.");
    solver.def("track", [](Main& s, nb::handle w, double age, double step) {
        const Wrench wrench = to_wrench(w);
        const std::lock_guard lock(s.busy);
        return Contact{s.context, wrench, s.live.track(wrench, age, step)};
    }, nb::arg("wrench"), nb::arg("age") = 0.0, nb::arg("step") = 0.0,
       "The same, with the sample's age in seconds and those since the sample before; 0: no torsion is learned from it.");
    solver.def("track_batch", [](Main& s, nb::handle wrenches, std::optional<Seconds> ages, std::optional<Seconds> steps) {
        const Rows6 rows = to_rows(wrenches);
        for (const auto& each : {ages, steps})
            if (each && each->shape(0) != rows.shape(0))
                throw nb::value_error("ages and steps must have one entry per wrench");
        const double *age = ages ? ages->data() : nullptr, *step = steps ? steps->data() : nullptr;
        return track_rows(s, rows, [&](std::size_t i, const Wrench& w) {
            return s.live.track(w, age ? age[i] : 0.0, step ? step[i] : 0.0);
        });
    }, nb::arg("wrenches"), nb::arg("ages").none() = nb::none(), nb::arg("steps").none() = nb::none(),
       "A stretch of one stream (n, 6), in order; with each sample's age, and the time since the sample before, in"
       " seconds (n,).");
    solver.def("reset", [](Main& s) {
        const std::lock_guard lock(s.busy);
        s.live.reset();
    }, "Forget the stream: the next sample is a first one.");
    solver.def_prop_ro("previous", [](Main& s) -> nb::object {
        const std::lock_guard lock(s.busy);
        return s.live.previous() ? to_array(*s.live.previous()) : nb::none();
    }, "(3,) the contact that track follows, S, m, or None.");
    solver.def("locate_exhaustively", [](const Main& s, nb::handle w) {
        const Wrench wrench = to_wrench(w);
        return Contact{s.context, wrench, s.context->locate_exhaustively(wrench)};
    }, nb::arg("wrench"), "The yardstick: every facet looked at, same answer.");
    solver.def("search_differences", &search_differences, nb::arg("wrenches"), nb::arg("previous").none(),
               "Rows (k,) where the pruned search and every facet one by one disagree in anything: reason, candidates, "
               "misfit, confidence, to the bit.");
    solver.def("time_tracking", [](Main& s, nb::handle rows) {
        return time_rows(to_rows(rows), [&](const Wrench& w) {
            const std::lock_guard lock(s.busy);
            return s.live.track(w);
        });
    }, nb::arg("wrenches"), "Nanoseconds of each tracked solve (n,).");
    solver.def("foreign_batch", &foreign_batch, nb::arg("wrenches"), nb::arg("points"), nb::arg("faces"),
               nb::arg("torques"), "Contacts found by another method, given this solver's mesh, gates and noise.");
    solver.def_prop_ro("closed", [](const Main& s) { return s.context->model().closed; },
                       "True when every edge joins two facets of matching winding.");
}

}  // namespace

std::shared_ptr<const Model> to_model(const Rows3& vertices, const Faces& faces, const Ints& region, const Bonus& bonus,
                                      double mesh_deviation, bool mesh_curved) {
    std::vector<Vec3> points = to_points(vertices);
    const std::vector<Triangle> triangles = to_triangles(faces);
    std::vector<std::int32_t> ranks(region.data(), region.data() + region.shape(0));
    const std::vector<double> odds(bonus.data(), bonus.data() + bonus.shape(0));
    nb::gil_scoped_release release;
    return std::make_shared<const Model>(
        make_model(std::move(points), triangles, std::move(ranks), odds, {mesh_deviation, mesh_curved}));
}

void bind_solvers(nb::module_& m) {
    bind_batch(m);
    bind_main(m);
    auto scan = nb::class_<Scan>(m, "Scan", "Exhaustive scan over structure-of-arrays.").def(nb::init<const Main&>());
    bind_method(scan);
    auto one = nb::class_<Algorithm1>(m, "Algorithm1", "The paper's loop over planes, taken literally.")
                   .def(nb::init<const Main&>());
    bind_method(one);
    auto iterative = nb::class_<Iterative>(m, "Iterative", "Levenberg-Marquardt on a fitted paraboloid.");
    iterative.def("__init__", [](Iterative* self, const Main& s, Vector3 origin,
                                 nb::ndarray<const double, nb::shape<3, 3>, nb::c_contig, nb::device::cpu> axes,
                                 Vector6 coefficients, double reach) {
        Paraboloid p;
        p.origin = three(origin.data());
        for (std::size_t i = 0; i < 3; ++i) p.axis[i] = three(axes.data() + 3 * i);
        std::copy(coefficients.data(), coefficients.data() + 6, p.c);
        p.reach = reach;
        new (self) Iterative{s.context, p};
    }, nb::arg("solver"), nb::arg("origin"), nb::arg("axes"), nb::arg("coefficients"), nb::arg("reach"));
    bind_method(iterative);
}

}  // namespace contactbench::bindings
