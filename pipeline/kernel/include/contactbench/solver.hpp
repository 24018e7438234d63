// From a wrench to a contact, with a reason: everything above put together.
//
// The likeliest touch is the one of least cost among those that explain the wrench (d2 <= implausible_misfit): d2 less
// the prior of its facet (regions, untouchable facets) and of being near the last contact. Then, away from it, the next
// likely ones, while they are worth a thought. Among these, what lies behind another costs more, and `decide` says what
// they are worth together.
//
// Contract
//   units      S frame, N, N*m, m, s.
//   locate     const and thread-safe. The same wrench and previous contact give the same answer,
//              bit for bit, whatever came before.
//   track      one stream, not thread-safe. Equal to locate with the last followed contact as
//              `previous`, as long as that is recent; but where a second touch has joined it, it says so.
//   cost       O(log n) where the wrench is precise against the probe's size; no allocation.
#pragma once

#include <memory>
#include <utility>

#include "second_touch.hpp"

namespace contactbench {

// Axes further than this many mesh sizes away miss the probe; single-precision bounds are too coarse to say by how much.
inline constexpr double far_moment = 1e3;

// Steeper than this, whether the force pushes is rounding.
inline constexpr double steepest_cosine = 1e-3;

class Solver {
public:
    Solver(std::shared_ptr<const Model> model, const WrenchCovariance& noise, double torsion_arm, const Gates& gates)
        : model_(std::move(model)), uncertainty_(noise, torsion_arm, model_->frame),
          doubled_(twice(noise), torsion_arm, model_->frame), gates_(gates) {}

    const Model& model() const { return *model_; }
    // Another uncertainty of the wrench from the next call on.
    void set_noise(const WrenchCovariance& noise) {
        const double arm = uncertainty_.torsion_arm;
        uncertainty_ = Uncertainty(noise, arm, model_->frame);
        doubled_ = Uncertainty(twice(noise), arm, model_->frame);
    }

    const Uncertainty& uncertainty() const { return uncertainty_; }
    const Gates& gates() const { return gates_; }

    // `previous`: where contact was last accepted (S, m), or null.
    Answer locate(const Wrench& w, const Vec3* previous = nullptr) const {
        Answer a;
        answer<Search>(w, previous, -1, a);
        return a;
    }

    // The yardstick: the same answer with every facet looked at.
    Answer locate_exhaustively(const Wrench& w, const Vec3* previous = nullptr) const {
        Answer a;
        answer<Exhaustion>(w, previous, -1, a);
        return a;
    }

    // `age`: seconds since the sample was taken.
    Answer track(const Wrench& w, double age = 0.0) {
        Answer a;
        track(w, age, a);
        return a;
    }

    // The same into `a`, whatever it held.
    void track(const Wrench& w, double age, Answer& a) {
        a.clear();
        a.reason = Reason::stale;
        if (age <= gates_.max_age) answer<Search>(w, previous(), hint_, a);
        if (a.count > 0) hint_ = a.candidates[a.chosen < 0 ? 0 : a.chosen].slot;
        // What is being followed, and what has joined it; see second_touch.hpp.
        const auto alone = [&](const Wrench& step, Answer& out) {
            out.clear();
            Solver::answer<Search>(doubled_, step, nullptr, -1, out);
        };
        pair_.observe(w, gates_, previous() != nullptr, a, alone);
        if (followed(a.reason, gates_)) {
            last_ = a.contact()->point;
            touched_ = true;
            misses_ = 0;
        } else if (a.reason == Reason::two_touches) {
            misses_ = 0;  // the first is still there
        } else if (touched_ && misses_ < std::numeric_limits<std::int64_t>::max()) {
            ++misses_;
        }
    }

    // The contact that `track` will follow next, or null.
    const Vec3* previous() const { return touched_ && misses_ <= gates_.recent_samples ? &last_ : nullptr; }

    void reset() {
        touched_ = false;
        hint_ = -1;
        pair_.reset();
    }

    // Of a point on a plane, whoever found it there, and off it along the force by `depth`; S, m^2.
    Mat3 covariance(const Wrench& w, Vec3 point, Vec3 normal, std::int32_t face, double depth) const {
        const Query q = make_query(model_->frame, w, uncertainty_);
        return covariance(q, point, normal, face, depth);
    }

    // The reason of an answer, or uncertain where it would be accepted, but is not as near as gates().sigma_max asks.
    Reason asked_near(const Wrench& w, const Candidate& c, Reason reason) const {
        return gates_.sigma_max > 0.0 ? asked_near(make_query(model_->frame, w, uncertainty_), c, reason) : reason;
    }

private:
    Reason asked_near(const Query& q, const Candidate& c, Reason reason) const {
        if (!(gates_.sigma_max > 0.0) || !accepted(reason, gates_)) return reason;
        const Mat3 s = covariance(q, c.point, c.normal, c.face, c.depth);
        return largest_sigma(s, c.normal) <= gates_.sigma_max ? reason : Reason::uncertain;
    }

    Mat3 covariance(const Query& q, Vec3 point, Vec3 normal, std::int32_t face, double depth) const {
        Mat3 s = plane_covariance(model_->frame, q, normal, depth_of(q, point), mesh_error(face));
        widen(s, depth * q.f);
        return s;
    }

    // By a standard deviation along a direction.
    static void widen(Mat3& s, Vec3 along) {
        const double v[3] = {along.x, along.y, along.z};
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) s.m[i][j] += v[i] * v[j];
    }

    double depth_of(const Query& q, Vec3 point) const {
        return dot((1.0 / model_->frame.scale) * (point - model_->frame.centre), q.f);
    }

    // Of no face: none, for who found the point knows another surface.
    MeshError<double> mesh_error(std::int32_t face) const {
        if (face < 0) return {};
        return model_->errors[std::size_t(face)];
    }

    // `a` comes cleared.
    template <class Finder>
    void answer(const Wrench& w, const Vec3* previous, std::int32_t hint, Answer& a) const {
        answer<Finder>(uncertainty_, w, previous, hint, a);
    }

    template <class Finder>
    void answer(const Uncertainty& uncertainty, const Wrench& w, const Vec3* previous, std::int32_t hint,
                Answer& a) const {
        a.reason = gate(w, gates_);
        if (a.reason != Reason::ok) return;
        const Query q = make_query(model_->frame, w, uncertainty);
        a.arm = model_->frame.scale * q.form.h;
        a.reason = Reason::implausible;
        if (!(norm2(q.m) < far_moment * far_moment)) {
            // What the torsion alone costs, wherever the touch were.
            const Form<double>& o = q.form;
            a.misfit = std::max(gates_.implausible_misfit, o.h * o.h / (o.ff + o.arm2));
            return;
        }
        Hunt hunt;
        hunt.cos_friction = std::max(gates_.cos_friction, steepest_cosine) - tie;
        hunt.most_misfit = gates_.implausible_misfit;
        hunt.previous = previous;
        hunt.follow_cost = previous ? gates_.follow_cost : 0.0;
        hunt.follow_distance = gates_.follow_distance;
        hunt.depth = gates_.depth_distance;
        Finder finder(*model_, q, hunt.cos_friction);
        detail::Found found = finder.first(hunt, hint);
        if (found.touch.slot < 0) return miss<Finder>(w, q, hunt, a);
        hunt.least_prior = found.touch.prior;
        settle(finder, q, hunt, found.touch);
        // Without the prior, or with it: whatever is a rival either way.
        hunt.limit = found.key + gates_.rival_cost;
        hunt.more = gates_.behind_cost;
        hunt.rival = found.touch.misfit - found.touch.follow - found.touch.prior + gates_.rival_cost - gates_.behind_cost;
        detail::Layers layers;
        while (a.count < Answer::capacity) {
            Candidate& c = a.candidates[a.count++] = found.touch;
            if (a.count > 1) place(q, c);
            hunt.away = a.candidates;
            hunt.radius[hunt.away_count++] = detail::own_radius(c, gates_);
            // What the line of force meets before the likeliest touch makes that less likely, and rivals more.
            if (detail::hides(c, a.candidates[0], gates_, q.f)) hunt.limit += std::exchange(hunt.more, 0.0);
            hunt.layers = a.count == 1 && hunt.depth > 0.0;
            found = finder.next(hunt);
            if (found.layered) layers = found.layers;
            if (found.touch.slot < 0) break;
        }
        layer(q, a.candidates[0], layers);
        const Candidate& best = a.candidates[decide(a, gates_, q.f)];
        a.left_over = left_over(w, best);
        a.reason = asked_near(q, best, a.reason);
    }

    void place(const Query& q, Candidate& c) const {
        c.slope = q.f + c.cosine * c.normal;
        c.across = sigma_across(model_->frame, q, c.normal, depth_of(q, c.point), mesh_error(c.face));
    }

    // Odds chose the place: in it, the wrench chooses the point.
    template <class Finder>
    void settle(Finder& finder, const Query& q, Hunt hunt, Candidate& c) const {
        place(q, c);
        if (!(hunt.depth > 0.0) || gates_.region_only || (model_->kinds.size() == 1 && c.follow == 0.0)) return;
        hunt.inside = &c, hunt.radius[0] = detail::own_radius(c, gates_);
        hunt.previous = nullptr, hunt.follow_cost = 0.0;
        hunt.least_prior = model_->most_bonus, hunt.limit = c.misfit - hunt.least_prior + tie;
        move(q, c, finder.next(hunt).touch);
    }

    // To another touch of its place.
    void move(const Query& q, Candidate& c, Candidate to) const {
        to.prior = c.prior, to.follow = c.follow, to.behind = c.behind, to.why = c.why;
        c = to;
        place(q, c);
    }

    // Of surfaces at the place of `c` that are as likely the one that is met first; what they leave open is told.
    void layer(const Query& q, Candidate& c, const detail::Layers& layers) const {
        if (layers.first.slot >= 0) move(q, c, layers.first);
        c.depth = std::max(std::sqrt(layers.variance), tie * layers.height * gates_.depth_distance);
    }

    // Without the torsion that a touch may have: a larger one is left over, too.
    double left_over(const Wrench& w, const Candidate& c) const {
        const double most = std::sqrt(gates_.implausible_misfit) * uncertainty_.torsion_arm * norm(w.F);
        return norm(w.M - cross(c.point, w.F) - std::min(std::max(c.torque, -most), most) * c.normal);
    }

    // Nothing explains the wrench: say by how much the best touch fails, and whether one beyond the friction cone would do.
    template <class Finder>
    void miss(const Wrench& w, const Query& q, Hunt hunt, Answer& a) const {
        constexpr double cos_grazing = 0.0174524064372835;  // of 89 degrees
        hunt.most_misfit = HUGE_VAL;
        hunt.previous = nullptr;
        hunt.follow_cost = 0.0;
        // The prior has no say in how well a touch explains a wrench.
        hunt.least_prior = model_->most_bonus;
        detail::Found best = Finder(*model_, q, hunt.cos_friction).first(hunt, -1);
        if (best.touch.slot < 0) a.reason = Reason::off_surface;
        else a.misfit = best.touch.misfit, a.left_over = left_over(w, best.touch);
        if (hunt.cos_friction <= cos_grazing) return;
        hunt.cos_friction = cos_grazing;
        hunt.most_misfit = gates_.implausible_misfit;
        if (Finder(*model_, q, cos_grazing).first(hunt, -1).touch.slot >= 0) a.reason = Reason::tangential;
    }

    static WrenchCovariance twice(WrenchCovariance c) {
        for (auto& row : c.s)
            for (double& value : row) value *= 2.0;
        return c;
    }

    std::shared_ptr<const Model> model_;
    Uncertainty uncertainty_;
    Uncertainty doubled_;  // of the difference of two wrenches
    Gates gates_;
    Vec3 last_;
    SecondTouch pair_;
    std::int32_t hint_ = -1;
    bool touched_ = false;
    std::int64_t misses_ = 0;
};

}  // namespace contactbench
