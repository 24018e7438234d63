// The runtime for Python: the same class that the C library wraps.
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>

#include <mutex>

#include "bindings.hpp"
#include "contactbench/runtime.hpp"
#include "line.hpp"

namespace contactbench::bindings {

namespace {

using Matrix3 = nb::ndarray<const double, nb::shape<3, 3>, nb::c_contig, nb::device::cpu>;
using Rotations = nb::ndarray<const double, nb::shape<-1, 3, 3>, nb::c_contig, nb::device::cpu>;
using Doubles = nb::ndarray<const double, nb::shape<-1>, nb::c_contig, nb::device::cpu>;
using Vector12 = nb::ndarray<const double, nb::shape<12>, nb::c_contig, nb::device::cpu>;
using Matrix12 = nb::ndarray<const double, nb::shape<12, 12>, nb::c_contig, nb::device::cpu>;
using Places = nb::ndarray<const double, nb::shape<6, 3>, nb::c_contig, nb::device::cpu>;
using Rows = nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using Changing = nb::ndarray<double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Vector11 = nb::ndarray<const double, nb::shape<11>, nb::c_contig, nb::device::cpu>;

struct PyRuntime {
    Runtime runtime;
    std::mutex busy;
};

struct RuntimeBatch {
    std::shared_ptr<std::vector<RuntimeContact>> rows;
};

template <class Array>
void copy_finite(const Array& from, double* to, const char* what) {
    for (std::size_t i = 0; i < from.size(); ++i) {
        if (!std::isfinite(from.data()[i])) throw std::invalid_argument(std::string(what) + " is not finite");
        to[i] = from.data()[i];
    }
}

std::vector<Section> to_sections(const Rows6& rows) {
    std::vector<Section> sections(rows.shape(0));
    for (std::size_t i = 0; i < sections.size(); ++i) {
        double v[6];
        for (std::size_t k = 0; k < 6; ++k) v[k] = rows.data()[6 * i + k];
        for (const double x : v)
            if (!std::isfinite(x)) throw std::invalid_argument("a section of the low-pass is not finite");
        if (v[3] != 1.0) throw std::invalid_argument("a section of the low-pass has a0 other than 1");
        sections[i] = {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
    }
    return sections;
}

void set_mount(RuntimeSettings& s, nb::object R_ES) {
    if (R_ES.is_none()) return;
    Matrix3 m;
    if (!nb::try_cast(R_ES, m)) throw nb::type_error("R_ES must be a float64 matrix (3, 3) or None");
    copy_finite(m, s.R_ES, "R_ES");
    s.has_mount = true;
}

// `motion`: window and radius of gyration.
void set_motion(RuntimeSettings& s, nb::object motion) {
    if (motion.is_none()) return;
    const auto [window, gyration] = nb::cast<std::pair<double, double>>(motion);
    if (!(window > 0.0 && gyration >= 0.0)) throw std::invalid_argument("motion: the window must be positive");
    s.motion = {true, window, gyration};
}

RuntimeSample to_sample(const double* wrench, double time, double arrival, std::uint32_t flags) {
    RuntimeSample sample{};
    std::copy(wrench, wrench + 6, sample.wrench);
    sample.time = time, sample.arrival = arrival, sample.flags = flags;
    return sample;
}

// Of a whole recording; what led to a run that is told frozen was frozen, too.
nb::object frozen(Rows6 wrenches, double chance) {
    const std::size_t n = wrenches.shape(0);
    std::unique_ptr<bool[]> told(new bool[n]());
    FrozenDetector detector;
    std::size_t begin = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const double* w = wrenches.data() + 6 * i;
        if (i > 0 && !std::equal(w, w + 6, w - 6)) begin = i;
        if (detector.see(w, chance)) std::fill(told.get() + begin, told.get() + i + 1, true), begin = i;
    }
    bool* data = told.release();
    nb::capsule owner(data, [](void* p) noexcept { delete[] static_cast<bool*>(p); });
    return nb::cast(nb::ndarray<nb::numpy, bool>(data, {n}, owner));
}

// Of a whole recording: R (n, 3, 3) and p (n, 3) at each of `times`; NaN where there is none.
nb::object poses_at(Doubles moments, Rotations R, Rows3 p, Doubles times, double longest_gap, double longest_ahead) {
    const std::size_t n = moments.shape(0), m = times.shape(0);
    if (R.shape(0) != n || p.shape(0) != n) throw nb::value_error("moments, R and p must have one row per pose");
    for (std::size_t i = 0; i < n; ++i)
        if (!std::isfinite(moments.data()[i]) || (i > 0 && !(moments.data()[i] > moments.data()[i - 1])))
            throw nb::value_error("moments must be finite and increase");
    const auto pose = [&](std::ptrdiff_t i) {
        Pose found;
        found.time = moments.data()[i];
        std::copy_n(R.data() + 9 * i, 9, found.R);
        std::copy_n(p.data() + 3 * i, 3, found.p);
        return found;
    };
    const PosePolicy policy{longest_gap, longest_ahead};
    std::vector<double> turned(9 * m, detail::unknown), placed(3 * m, detail::unknown);
    for (std::size_t i = 0; i < m; ++i) {
        const double t = times.data()[i];
        const double* after = std::upper_bound(moments.data(), moments.data() + n, t);
        const std::ptrdiff_t base = after - moments.data() - 1;
        Pose found;
        if (!std::isfinite(t) || !pose_at(pose, std::ptrdiff_t(n), base, t, policy, found)) continue;
        std::copy_n(found.R, 9, turned.data() + 9 * i);
        std::copy_n(found.p, 3, placed.data() + 3 * i);
    }
    return nb::make_tuple(make_array(std::move(turned), {m, 3, 3}), make_array(std::move(placed), {m, 3}));
}

// `kalman`: rate, q, r, tuned rate, 1 for per sample; then of an adaptive one the noise of a reading, else zeros.
void set_kalman(RuntimeSettings& s, nb::object kalman) {
    if (kalman.is_none()) return;
    Vector11 v;
    if (!nb::try_cast(kalman, v)) throw nb::type_error("kalman must be eleven float64 numbers or None");
    double k[11];
    copy_finite(v, k, "kalman");
    for (int i = 0; i < 4; ++i)
        if (!(k[i] > 0.0)) throw std::invalid_argument("kalman: rate, q, r and tuned rate must be positive");
    s.filter_wrench = true;
    s.kalman = {k[0], k[1], k[2], k[3], k[4] != 0.0, std::all_of(k + 5, k + 11, [](double x) { return x > 0.0; })};
    std::copy(k + 5, k + 11, s.kalman.sigma);
}

GravityLoad to_load(const Vector12& gravity) {
    double g[12];
    copy_finite(gravity, g, "the gravity model");
    return {three(g), three(g + 3), three(g + 6), three(g + 9)};
}

// `covariance`: of the gravity model, or None: it is known.
ZeroSettings to_zero_settings(nb::object covariance, double orientation_sigma) {
    ZeroSettings s;
    if (!(orientation_sigma >= 0.0 && orientation_sigma < 1.0))
        throw std::invalid_argument("orientation_sigma is no small angle, rad");
    s.orientation = orientation_sigma;
    if (covariance.is_none()) return s;
    Matrix12 m;
    if (!nb::try_cast(covariance, m))
        throw nb::type_error("the covariance of the gravity model must be a float64 matrix (12, 12) or None");
    copy_finite(m, &s.covariance[0][0], "the covariance of the gravity model");
    return s;
}

struct Samples {
    Rows6 wrenches;
    Rotations rotations;
    Doubles times;

    std::size_t size() const { return times.shape(0); }
    Samples(Rows6 w, Rotations R, Doubles t) : wrenches(w), rotations(R), times(t) {
        if (wrenches.shape(0) != size() || rotations.shape(0) != size())
            throw nb::value_error("wrenches, rotations and times must have one row per sample");
    }
    RuntimeContact run(Runtime& runtime, std::size_t i) const {
        return runtime.update(wrenches.data() + 6 * i, rotations.data() + 9 * i, times.data()[i]);
    }
};

RuntimeBatch update_batch(PyRuntime& self, Rows6 wrenches, Rotations rotations, Doubles times) {
    const Samples samples(wrenches, rotations, times);
    auto rows = std::make_shared<std::vector<RuntimeContact>>(samples.size());
    nb::gil_scoped_release release;
    const std::lock_guard lock(self.busy);
    for (std::size_t i = 0; i < samples.size(); ++i) (*rows)[i] = samples.run(self.runtime, i);
    return {std::move(rows)};
}

nb::object time_each(PyRuntime& self, Rows6 wrenches, Rotations rotations, Doubles times) {
    const Samples samples(wrenches, rotations, times);
    return time_calls(samples.size(), [&](std::size_t i) {
        const std::lock_guard lock(self.busy);
        return samples.run(self.runtime, i).face;
    });
}

// A strided view of one member of every row; it keeps the rows alive.
template <class T, class Member>
nb::object column(const RuntimeBatch& b, Member RuntimeContact::*member, std::initializer_list<std::size_t> inner) {
    nb::capsule owner(new std::shared_ptr<std::vector<RuntimeContact>>(b.rows), [](void* p) noexcept {
        delete static_cast<std::shared_ptr<std::vector<RuntimeContact>>*>(p);
    });
    std::vector<std::size_t> shape{b.rows->size()};
    std::vector<std::int64_t> strides{std::int64_t(sizeof(RuntimeContact) / sizeof(T))};
    shape.insert(shape.end(), inner);
    for (std::size_t i = 1; i < shape.size(); ++i) {
        std::int64_t step = 1;
        for (std::size_t k = i + 1; k < shape.size(); ++k) step *= std::int64_t(shape[k]);
        strides.push_back(step);
    }
    static RuntimeContact none;  // an address for an empty batch
    RuntimeContact& first = b.rows->empty() ? none : b.rows->front();
    const T* data = reinterpret_cast<const T*>(&(first.*member));
    return nb::cast(nb::ndarray<nb::numpy, const T>(data, shape.size(), shape.data(), owner, strides.data()));
}

nb::object index_or_none(std::int32_t i) { return i < 0 ? nb::none() : nb::cast(i); }

nb::object point_or_none(const double* p) {
    return std::isnan(p[0]) ? nb::none() : to_array(three(p));
}

nb::object six_or_none(const double* v) {
    return std::isnan(v[0]) ? nb::none() : make_array(std::vector<double>(v, v + 6), {6});
}

nb::object covariance_or_none(const RuntimeContact& c) {
    return std::isnan(c.covariance[0]) ? nb::none() : make_array(std::vector<double>(c.covariance, c.covariance + 9), {3, 3});
}

void bind_contact_class(nb::module_& m) {
    using C = RuntimeContact;
    nb::class_<C>(m, "RuntimeContact", "What the runtime says of one sample.")
        .def_ro("reason", &C::reason, "Reason.")
        .def_prop_ro("reason_name", [](const C& c) { return std::string(reason_name(c.reason)); }, "The same in words.")
        .def_prop_ro("accepted", [](const C& c) { return c.accepted != 0; }, "Safe to act on.")
        .def_ro("health", &C::health, "Health word; 0: nothing is wrong.")
        .def_ro("pose_age", &C::pose_age, "s: how much older than the sample the last pose before it is; NaN where there is none.")
        .def_ro("latency", &C::latency, "s: how old what it rests on was at the arrival; NaN where not known.")
        .def_ro("time", &C::time, "s, as given.")
        .def_prop_ro("point", [](const C& c) { return point_or_none(c.point); }, "(3,) S, m, or None.")
        .def_prop_ro("normal", [](const C& c) { return point_or_none(c.normal); }, "(3,) S, outward, or None.")
        .def_ro("torque", &C::torque_about_normal, "Local torque k, N·m; NaN without a point.")
        .def_prop_ro("wrench", [](const C& c) { return six_or_none(c.wrench); },
                     "(6,) S, N and N·m: compensated and filtered; None before the first sample that counts.")
        .def_prop_ro("covariance", &covariance_or_none, "(3, 3) S, m², or None.")
        .def_prop_ro("face", [](const C& c) { return index_or_none(c.face); }, "Face number, or None.")
        .def_prop_ro("vertex", [](const C& c) { return index_or_none(c.vertex); }, "Vertex number, or None.")
        .def_ro("region", &C::region, "Region rank, 0 for none.")
        .def_ro("candidates", &C::candidates, "How many, the chosen one included.")
        .def_prop_ro("filtered_point", [](const C& c) { return point_or_none(c.filtered_point); },
                     "(3,) S, m: low-passed, held while contact is lost for a moment; None after that.")
        .def_ro("misfit", &C::misfit, "d2 of the best touch, standard deviations squared.")
        .def_ro("left_over", &C::left_over, "Torque that it does not explain, N·m.")
        .def_ro("arm", &C::arm, "Torque along the force over the force, m.")
        .def_ro("torsion_arm", &C::torsion_arm, "m: torsion over force, 1 sigma, that it was judged by; NaN where nothing was located.")
        .def_ro("torsion_since", &C::torsion_since, "s: for how long that was learned; NaN: it is declared.")
        .def_ro("confidence", &C::confidence, "0 to 1, no probability.")
        .def_prop_ro("runner_up", [](const C& c) { return point_or_none(c.runner_up); }, "(3,) S, m: the likeliest other place, or None.")
        .def_ro("within", &C::within, "m: how far the 95 % ellipse of the point reaches; NaN where there is none.")
        .def_prop_ro("second", [](const C& c) { return point_or_none(c.second); }, "(3,) S, m: a touch that joined this one, or None.")
        .def_prop_ro("raw", [](const C& c) { return six_or_none(c.raw); },
                     "(6,) S, N and N·m: as the sensor reads it; None for a sample that was not used.")
        .def_prop_ro("taken", [](const C& c) { return six_or_none(c.taken); },
                     "(6,) S, N and N·m: off the compensated wrench, because the zero follows.")
        .def("line", [](const C& c, const Zero& zero, double latency, std::int32_t on, bool nulls) {
            cb_contact told = runtime::to_c(c, on);
            told.latency = latency;
            const runtime::Line line(told, runtime::to_c(zero), nulls);
            return nb::bytes(line.view().data(), line.view().size());
        }, nb::arg("zero"), nb::arg("latency"), nb::arg("on") = std::int32_t(CB_ON_NOTHING), nb::arg("nulls") = true,
           "One line of JSON, as `cb_line` writes it; `on`: number of a facet mark; without `nulls` what is not there is left out.");
}

void bind_batch_class(nb::module_& m) {
    using B = RuntimeBatch;
    using C = RuntimeContact;
    nb::class_<B>(m, "RuntimeBatch", "What the runtime says of many samples, a row each; NaN and -1 for none.")
        .def("__len__", [](const B& b) { return b.rows->size(); })
        .def("__getitem__", [](const B& b, std::int64_t i) {
            const std::int64_t n = std::int64_t(b.rows->size());
            if (i < -n || i >= n) throw nb::index_error("row out of range");
            return (*b.rows)[std::size_t(i < 0 ? i + n : i)];
        }, nb::arg("row"), "One row.")
        .def_prop_ro("reasons", [](const B& b) { return column<std::int32_t>(b, &C::reason, {}); }, "(n,) int32.")
        .def_prop_ro("faces", [](const B& b) { return column<std::int32_t>(b, &C::face, {}); }, "(n,) int32.")
        .def_prop_ro("vertices", [](const B& b) { return column<std::int32_t>(b, &C::vertex, {}); }, "(n,) int32.")
        .def_prop_ro("regions", [](const B& b) { return column<std::int32_t>(b, &C::region, {}); }, "(n,) int32.")
        .def_prop_ro("candidates", [](const B& b) { return column<std::int32_t>(b, &C::candidates, {}); }, "(n,) int32.")
        .def_prop_ro("times", [](const B& b) { return column<double>(b, &C::time, {}); }, "(n,) s.")
        .def_prop_ro("points", [](const B& b) { return column<double>(b, &C::point, {3}); }, "(n, 3) S, m.")
        .def_prop_ro("normals", [](const B& b) { return column<double>(b, &C::normal, {3}); }, "(n, 3) S.")
        .def_prop_ro("torques", [](const B& b) { return column<double>(b, &C::torque_about_normal, {}); }, "(n,) k, N·m.")
        .def_prop_ro("wrenches", [](const B& b) { return column<double>(b, &C::wrench, {6}); }, "(n, 6) S, N and N·m.")
        .def_prop_ro("covariances", [](const B& b) { return column<double>(b, &C::covariance, {3, 3}); }, "(n, 3, 3) S, m².")
        .def_prop_ro("filtered_points", [](const B& b) { return column<double>(b, &C::filtered_point, {3}); }, "(n, 3) S, m.")
        .def_prop_ro("accepted", [](const B& b) { return column<std::int32_t>(b, &C::accepted, {}); }, "(n,) int32: 1 where safe to act on.")
        .def_prop_ro("healths", [](const B& b) { return column<std::uint32_t>(b, &C::health, {}); }, "(n,) uint32.")
        .def_prop_ro("misfits", [](const B& b) { return column<double>(b, &C::misfit, {}); }, "(n,) standard deviations squared.")
        .def_prop_ro("left_overs", [](const B& b) { return column<double>(b, &C::left_over, {}); }, "(n,) N·m.")
        .def_prop_ro("arms", [](const B& b) { return column<double>(b, &C::arm, {}); }, "(n,) m.")
        .def_prop_ro("torsion_arms", [](const B& b) { return column<double>(b, &C::torsion_arm, {}); }, "(n,) m.")
        .def_prop_ro("torsion_since", [](const B& b) { return column<double>(b, &C::torsion_since, {}); }, "(n,) s.")
        .def_prop_ro("confidences", [](const B& b) { return column<double>(b, &C::confidence, {}); }, "(n,) 0 to 1, no probabilities.")
        .def_prop_ro("runners_up", [](const B& b) { return column<double>(b, &C::runner_up, {3}); }, "(n, 3) S, m.")
        .def_prop_ro("seconds", [](const B& b) { return column<double>(b, &C::second, {3}); }, "(n, 3) S, m.")
        .def_prop_ro("taken", [](const B& b) { return column<double>(b, &C::taken, {6}); }, "(n, 6) S, N and N·m.");
}

void bind_zero(nb::module_& m) {
    nb::class_<Zero>(m, "Zero", "How old the sensor's zero is, and how far it is off.")
        .def_prop_ro("state", [](const Zero& z) { return std::string(zero_state_name(z.state)); },
                     "unknown, confirmed, doubtful or off.")
        .def_ro("age", &Zero::age, "s since the last moment without touch; NaN: there was none.")
        .def_prop_ro("offset", [](const Zero& z) { return six_or_none(z.offset); },
            "(6,) S, N and N·m: what the reading has too much; None where that is not known.")
        .def_prop_ro("sigma", [](const Zero& z) { return six_or_none(z.sigma); },
            "(6,) standard deviations of `offset`, the calibration's share included, or None.")
        .def_ro("shift", &Zero::shift, "m: by how much that moves a contact of 10 N, where it does so most; NaN: not known.")
        .def_ro("shift_sigma", &Zero::shift_sigma, "m, one standard deviation.")
        .def_prop_ro("follows", [](const Zero& z) { return std::string(follows_name(z.follows)); },
                     "off, waiting, following or stopped: is what was seen of it taken off?")
        .def_prop_ro("taken", [](const Zero& z) { return six_or_none(z.taken); },
                     "(6,) S, N and N·m: what is taken off, or None.")
        .def_prop_ro("taken_sigma", [](const Zero& z) { return six_or_none(z.taken_sigma); },
                     "(6,) standard deviations of `taken`, or None.")
        .def_ro("seen", &Zero::seen, "s since the moment that `taken` rests on; NaN: there was none.");
    nb::class_<ZeroWatch>(m, "ZeroWatch", "Watches the sensor's zero, from moments in which nothing touches the probe.")
        .def("__init__", [](ZeroWatch* self, Vector12 gravity, nb::object covariance, Places places,
                            double orientation_sigma, double min_force) {
            ZeroWatch::Places far;
            for (std::size_t i = 0; i < far.size(); ++i) far[i] = three(places.data() + 3 * i);
            new (self) ZeroWatch(to_load(gravity), to_zero_settings(std::move(covariance), orientation_sigma), min_force,
                                 far);
        }, nb::arg("gravity"), nb::arg("covariance").none(), nb::arg("places"), nb::kw_only(),
           nb::arg("orientation_sigma"), nb::arg("min_force"))
        .def("see", [](ZeroWatch& self, Rows6 wrenches, Rotations rotations, Doubles times, bool touched) {
            const Samples samples(wrenches, rotations, times);
            for (std::size_t i = 0; i < samples.size(); ++i)
                self.see(to_wrench(wrenches.data() + 6 * i), rotations.data() + 9 * i, times.data()[i], touched);
        }, nb::arg("wrenches"), nb::arg("rotations"), nb::arg("times"), nb::arg("touched") = false,
           "The next samples: (n, 6) compensated but not filtered, (n, 3, 3) R_WS, (n,) s; whether a touch was located.")
        .def("at", &ZeroWatch::at, nb::arg("now"), "What is known of the zero; `now` in s of the samples' clock.");
    nb::class_<ZeroFollow>(m, "ZeroFollow", "What a zero that follows takes off, as in a runtime; one stream.")
        .def("__init__", [](ZeroFollow* self, double min_force) { new (self) ZeroFollow(true, min_force); },
             nb::arg("min_force"))
        .def("taken", [](ZeroFollow& self, Rows6 wrenches, Rotations rotations, Doubles times, double touch_force) {
            const Samples samples(wrenches, rotations, times);
            std::vector<double> out(6 * samples.size());
            for (std::size_t i = 0; i < samples.size(); ++i) {
                const Wrench w = to_wrench(wrenches.data() + 6 * i);
                if (!finite(w.F) || !finite(w.M)) {
                    self.lose();
                    std::copy_n(self.taken(), 6, out.data() + 6 * i);
                    continue;
                }
                const double* taken = self.taken();
                std::copy_n(taken, 6, out.data() + 6 * i);
                const bool touched = norm(w.F - three(taken)) >= touch_force;
                self.see(w, rotations.data() + 9 * i, times.data()[i], touched);
            }
            return make_array(std::move(out), {samples.size(), 6});
        }, nb::arg("wrenches"), nb::arg("rotations"), nb::arg("times"), nb::arg("touch_force"),
           "(n, 6) taken off the next samples: (n, 6) compensated, (n, 3, 3) R_WS, (n,) s; from `touch_force`, N, on it"
           " is a touch. What is not finite is a sample that is missing.")
        .def("at", [](const ZeroFollow& self, double now) {
            Zero told;
            self.tell(told, now);
            return told;
        }, nb::arg("now"), "What is taken off; `now` in s of the samples' clock.");
}

void bind_filters(nb::module_& m) {
    nb::class_<WrenchKalman>(m, "WrenchKalman", "The wrench filter of a Runtime; one stream.")
        .def("__init__", [](WrenchKalman* self, nb::object kalman) {
            RuntimeSettings s;
            set_kalman(s, std::move(kalman));
            new (self) WrenchKalman(s.kalman);
        }, nb::arg("kalman"))
        .def("reset", &WrenchKalman::reset)
        .def_prop_ro("variance", &WrenchKalman::variance)
        .def("update", [](WrenchKalman& self, Rows6 rows, Doubles steps) {
            std::vector<double> out(rows.size(), detail::unknown);
            for (std::size_t i = 0; i < std::min(rows.shape(0), steps.shape(0)); ++i) {
                const double* row = rows.data() + 6 * i;
                if (std::all_of(row, row + 6, [](double x) { return std::isfinite(x); })) self.update(row, steps.data()[i]);
                else self.skip(steps.data()[i]);
                if (self.started()) std::copy(self.state(), self.state() + 6, out.data() + 6 * i);
            }
            return make_array(std::move(out), {rows.shape(0), 6});
        }, nb::arg("rows"), nb::arg("steps"), "Rows (n, 6), each so many seconds after the one before; (n, 6).");
    m.def("kalman", [](Rows rows, Doubles added, double r, Changing state, Changing variance) {
        const std::size_t count = rows.shape(1);
        std::vector<double> out(rows.size(), detail::unknown);
        if (state.size() != count || variance.size() != count || added.size() != rows.shape(0))
            throw std::invalid_argument("one number per row or channel");
        double *x = state.data(), *v = variance.data();
        for (std::size_t at = 0; at < rows.size(); ++at) {
            const std::size_t c = at % count;
            const double z = rows.data()[at], before = v[c] + added.data()[at / count], gain = 1 / (1 + r / before);
            v[c] = std::isfinite(z) ? gain * r : before;
            if (std::isfinite(z)) x[c] = blend(x[c], z, gain);
            if (v[c] < HUGE_VAL) out[at] = x[c];
        }
        return make_array(std::move(out), {rows.shape(0), count});
    }, nb::arg("rows"), nb::arg("added"), nb::arg("r"), nb::arg("state"), nb::arg("variance"),
       "Rows (n, c) through a fixed filter, each channel on its own; (n, c). Changes state and variance (c,).");
}

}  // namespace

void bind_runtime(nb::module_& m) {
    bind_filters(m);
    bind_contact_class(m);
    bind_batch_class(m);
    bind_zero(m);
    auto runtime = nb::class_<PyRuntime>(m, "Runtime", "What a controller runs at every sample; one stream.");
    runtime.def("__init__", [](PyRuntime* self, Rows3 vertices, Faces faces, Ints region, Matrix6 noise, Vector12 gravity,
                               nb::object kalman, Rows6 sections, Bonus bonus, double torsion_arm,
                               bool torsion_learned, double mesh_deviation, bool mesh_curved, nb::object R_ES, double pose_gap,
                               double pose_ahead, double silence, double frozen_chance, nb::object motion,
                               nb::object gravity_covariance, double orientation_sigma, bool follow,
                               const nb::dict& gates) {
        RuntimeSettings s;
        set_mount(s, std::move(R_ES));
        set_motion(s, std::move(motion));
        if (!(pose_gap > 0.0 && pose_ahead >= 0.0 && silence > 0.0 && frozen_chance > 0.0 && frozen_chance < 1.0))
            throw std::invalid_argument("pose_gap, pose_ahead, silence or frozen_chance is out of range");
        s.poses = {pose_gap, pose_ahead};
        s.silence = silence, s.frozen_chance = frozen_chance;
        s.gates = to_gates(gates);
        s.torsion = {torsion_arm, torsion_learned};
        copy_finite(noise, &s.noise.s[0][0], "the wrench covariance");
        s.gravity = to_load(gravity);
        s.zero = to_zero_settings(std::move(gravity_covariance), orientation_sigma);
        s.follow = follow;
        set_kalman(s, std::move(kalman));
        s.sections = to_sections(sections);
        new (self) PyRuntime{Runtime(to_model(vertices, faces, region, bonus, mesh_deviation, mesh_curved), s), {}};
    }, nb::arg("vertices"), nb::arg("faces").noconvert(), nb::arg("region").noconvert(), nb::arg("noise"),
       nb::arg("gravity"), nb::kw_only(), nb::arg("kalman").none(), nb::arg("sections"), nb::arg("bonus"),
       nb::arg("torsion_arm"), nb::arg("torsion_learned") = false, nb::arg("mesh_deviation"), nb::arg("mesh_curved"),
       nb::arg("R_ES").none(), nb::arg("pose_gap"), nb::arg("pose_ahead"), nb::arg("silence"), nb::arg("frozen_chance"),
       nb::arg("motion").none(), nb::arg("gravity_covariance").none() = nb::none(),
       nb::arg("orientation_sigma") = ZeroSettings().orientation, nb::arg("follow") = false, nb::arg("gates"));
    runtime.def("pose", [](PyRuntime& s, Matrix3 R, Vector3 p, double time) {
        const std::lock_guard lock(s.busy);
        return s.runtime.pose(R.data(), p.data(), time);
    }, nb::arg("R"), nb::arg("p"), nb::arg("time"),
       "The next pose: of the flange where the mount is known, else of the sensor; R (3, 3), p (3,) m, NaN where it is"
       " not known, s. False: it is not used.");
    runtime.def("locate", [](PyRuntime& s, Vector6 wrench, double time, double arrival, std::uint32_t flags) {
        const std::lock_guard lock(s.busy);
        return s.runtime.update(to_sample(wrench.data(), time, arrival, flags));
    }, nb::arg("wrench"), nb::arg("time"), nb::arg("arrival") = detail::unknown, nb::arg("flags") = 0,
       "The next sample, with the orientation at its time; `flags` as contactbench.pipeline.devices.sample.Status.");
    runtime.def("silent", [](PyRuntime& s, double now) -> std::optional<RuntimeContact> {
        const std::lock_guard lock(s.busy);
        RuntimeContact out;
        if (!s.runtime.silent(now, out)) return std::nullopt;
        return out;
    }, nb::arg("now"), "A contact that says that no sample comes, or None while they do.");
    nb::class_<FrozenDetector>(m, "FrozenDetector", "Tells readings that repeat beyond chance.")
        .def(nb::init<>())
        .def("see", [](FrozenDetector& d, std::array<double, 6> wrench, double chance) {
            return d.see(wrench.data(), chance);
        }, nb::arg("wrench"), nb::arg("chance"), "Takes the next reading (6 numbers).");
    m.def("frozen", &frozen, nb::arg("wrenches"), nb::arg("chance"),
          "(n,) bool: which of n readings (n, 6) in a row are part of a run that repeats beyond chance, its beginning"
          " included.");
    m.def("poses_at", &poses_at, nb::arg("moments"), nb::arg("R"), nb::arg("p"), nb::arg("times"),
          nb::arg("longest_gap"), nb::arg("longest_ahead"),
          "R (m, 3, 3) and p (m, 3) at times among n poses of increasing moments; NaN where there is none.");
    runtime.def("update", [](PyRuntime& s, Vector6 wrench, Matrix3 R_WS, double time) {
        const std::lock_guard lock(s.busy);
        return s.runtime.update(wrench.data(), R_WS.data(), time);
    }, nb::arg("wrench"), nb::arg("R_WS"), nb::arg("time"),
       "The next sample: a raw reading (6,) in S, N and N·m, the sensor's orientation (3, 3), and its time, s.");
    runtime.def("update_batch", &update_batch, nb::arg("wrenches"), nb::arg("rotations"), nb::arg("times"),
                "The next samples (n, 6), (n, 3, 3), (n,), in order, without the interpreter's lock.");
    runtime.def("time_each", &time_each, nb::arg("wrenches"), nb::arg("rotations"), nb::arg("times"),
                "Nanoseconds of each update (n,).");
    runtime.def("zero", [](PyRuntime& s) {
        const std::lock_guard lock(s.busy);
        return s.runtime.zero();
    }, "How old the sensor's zero is at the last sample, how far it is off, and what of that is taken off.");
    runtime.def("reset", [](PyRuntime& s) {
        const std::lock_guard lock(s.busy);
        s.runtime.reset();
    }, "Forget the stream: the next sample is a first one.");
}

}  // namespace contactbench::bindings
