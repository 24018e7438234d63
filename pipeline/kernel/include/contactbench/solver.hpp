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
//              bit for bit, whatever came before; by the torsion arm that is known beforehand.
//   track      one stream, not thread-safe. Equal to locate with the last followed contact as
//              `previous`, as long as that is recent; but by the torsion arm that the run has learned, and where a
//              second touch has joined it, it says so.
//   cost       O(log n) where the wrench is precise against the probe's size; no allocation.
#pragma once

#include <memory>
#include <utility>

#include "second_touch.hpp"
#include "torsion.hpp"

namespace contactbench {

// Axes further than this many mesh sizes away miss the probe; single-precision bounds are too coarse to say by how much.
inline constexpr double far_moment = 1e3;

// Steeper than this, whether the force pushes is rounding.
inline constexpr double steepest_cosine = 1e-3;

class Solver {
public:
    Solver(std::shared_ptr<const Model> model, const WrenchCovariance& noise, Torsion torsion, const Gates& gates)
        : model_(std::move(model)), uncertainty_(noise, model_->frame), doubled_(twice(noise), model_->frame),
          gates_(gates), torsion_(torsion) {}

    const Model& model() const { return *model_; }
    // Another uncertainty of the wrench from the next call on.
    void set_noise(const WrenchCovariance& noise) {
        uncertainty_ = Uncertainty(noise, model_->frame);
        doubled_ = Uncertainty(twice(noise), model_->frame);
    }

    const Torsion& torsion() const { return torsion_.start(); }
    const Gates& gates() const { return gates_; }

    // `previous`: where contact was last accepted (S, m), or null.
    Answer locate(const Wrench& w, const Vec3* previous = nullptr) const {
        return locate(w, previous, torsion().arm);
    }

    // By another torsion arm, m.
    Answer locate(const Wrench& w, const Vec3* previous, double arm) const {
        Answer a;
        answer<Search>(uncertainty_, w, previous, -1, Known{arm}, a);
        return a;
    }

    // The yardstick: the same answer with every facet looked at.
    Answer locate_exhaustively(const Wrench& w, const Vec3* previous = nullptr) const {
        Answer a;
        answer<Exhaustion>(uncertainty_, w, previous, -1, Known{torsion().arm}, a);
        return a;
    }

    // `age`: seconds since the sample was taken; `step`: since the sample before, 0: not known, and nothing is learned.
    Answer track(const Wrench& w, double age = 0.0, double step = 0.0) {
        Answer a;
        track(w, age, step, a);
        return a;
    }

    // The same into `a`, whatever it held.
    void track(const Wrench& w, double age, double step, Answer& a) {
        a.clear();
        a.reason = Reason::stale;
        if (!previous()) torsion_.reset();
        // The pitch tells of torsion before anything is searched: a touch that begins to spin is not lost by it.
        const auto learned = [&](const Form<double>& form) {
            const double scale = model_->frame.scale;
            if (previous() && !pair_.told()) torsion_.see(w, scale * form.h, scale * scale * form.ff, step, gates_);
            return torsion_.arm();
        };
        if (age <= gates_.max_age) answer<Search>(uncertainty_, w, previous(), hint_, learned, a);
        if (a.count > 0) hint_ = a.candidates[a.chosen < 0 ? 0 : a.chosen].slot;
        // What is being followed, and what has joined it; see second_touch.hpp.
        const auto alone = [&](const Wrench& change, Answer& out) {
            out.clear();
            Solver::answer<Search>(doubled_, change, nullptr, -1, Known{torsion().arm}, out);
        };
        pair_.observe(w, gates_, previous() != nullptr, a, alone);
        if (a.reason == Reason::two_touches) torsion_.reset();  // the pitch of two is no torsion
        a.torsion_since = torsion_.since();
        if (followed(a.reason, gates_)) {
            torsion_.note(w, *a.contact(), step, gates_);
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
        torsion_.reset();
    }

    // Of a point on a plane, whoever found it there, off it along the force by `depth`, by a torsion arm, m; S, m^2.
    Mat3 covariance(const Wrench& w, Vec3 point, Vec3 normal, std::int32_t face, double depth, double arm) const {
        return covariance(query(w, arm), point, normal, face, depth, arm);
    }

    // The reason of an answer, or uncertain where it would be accepted, but is not as near as gates().sigma_max asks.
    Reason asked_near(const Wrench& w, const Candidate& c, Reason reason) const {
        return gates_.sigma_max > 0.0 ? asked_near(query(w, torsion().arm), c, torsion().arm, reason) : reason;
    }

private:
    Query query(const Wrench& w, double arm) const {
        Query q = make_query(model_->frame, w, uncertainty_);
        set_arm(model_->frame, arm, q);
        return q;
    }

    Reason asked_near(const Query& q, const Candidate& c, double arm, Reason reason) const {
        if (!(gates_.sigma_max > 0.0) || !accepted(reason, gates_)) return reason;
        const Mat3 s = covariance(q, c.point, c.normal, c.face, c.depth, arm);
        return largest_sigma(s) <= gates_.sigma_max ? reason : Reason::uncertain;
    }

    Mat3 covariance(const Query& q, Vec3 point, Vec3 normal, std::int32_t face, double depth, double arm) const {
        Mat3 s = plane_covariance(model_->frame, q, normal, depth_of(q, point), mesh_error(face));
        widen(s, depth * q.f);
        // What twists the probe is an area, and friction on it moves the point along the slide.
        const double cosine = std::max(-dot(normal, q.f), steepest_cosine);
        widen(s, (std::sqrt(torsion_.patch2(arm)) / cosine) * (q.f + cosine * normal));
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

    // An arm that does not depend on the wrench.
    struct Known {
        double arm;
        double operator()(const Form<double>&) const { return arm; }
    };

    // `a` comes cleared. `arm_of(form)`: the torsion arm to judge by, m.
    template <class Finder, class Arm>
    void answer(const Uncertainty& uncertainty, const Wrench& w, const Vec3* previous, std::int32_t hint, Arm&& arm_of,
                Answer& a) const {
        a.reason = gate(w, gates_);
        if (a.reason != Reason::ok) return;
        Query q = make_query(model_->frame, w, uncertainty);
        a.torsion_arm = arm_of(q.form);
        set_arm(model_->frame, a.torsion_arm, q);
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
        detail::Found found;
        finder.first(hunt, hint, found);
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
            finder.next(hunt, found);
            if (found.layered) layers = found.layers;
            if (found.touch.slot < 0) break;
        }
        layer(q, a.candidates[0], layers);
        const Candidate& best = a.candidates[decide(a, gates_, q.f)];
        a.left_over = left_over(w, best, a.torsion_arm);
        a.reason = asked_near(q, best, a.torsion_arm, a.reason);
    }

    void place(const Query& q, Candidate& c) const {
        c.slope = q.f + c.cosine * c.normal;
        c.across = sigma_across(model_->frame, q, c.normal, depth_of(q, c.point), mesh_error(c.face));
    }

    // Odds chose the place: in it, the wrench chooses the point.
    template <class Finder>
    void settle(Finder& finder, const Query& q, const Hunt& first, Candidate& c) const {
        place(q, c);
        if (!(first.depth > 0.0) || gates_.region_only || (model_->kinds.size() == 1 && c.follow == 0.0)) return;
        Hunt hunt = first;
        detail::Found found;
        hunt.inside = &c, hunt.radius[0] = detail::own_radius(c, gates_);
        hunt.previous = nullptr, hunt.follow_cost = 0.0;
        hunt.least_prior = model_->most_bonus, hunt.limit = c.misfit - hunt.least_prior + tie;
        finder.next(hunt, found);
        move(q, c, found.touch);
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
    double left_over(const Wrench& w, const Candidate& c, double arm) const {
        const double most = std::sqrt(gates_.implausible_misfit) * arm * norm(w.F);
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
        detail::Found best;
        Finder(*model_, q, hunt.cos_friction).first(hunt, -1, best);
        if (best.touch.slot < 0) a.reason = Reason::off_surface;
        else a.misfit = best.touch.misfit, a.left_over = left_over(w, best.touch, a.torsion_arm);
        if (hunt.cos_friction <= cos_grazing) return;
        hunt.cos_friction = cos_grazing;
        hunt.most_misfit = gates_.implausible_misfit;
        Finder(*model_, q, cos_grazing).first(hunt, -1, best);
        if (best.touch.slot >= 0) a.reason = Reason::tangential;
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
    TorsionArm torsion_;
    std::int32_t hint_ = -1;
    bool touched_ = false;
    std::int64_t misses_ = 0;
};

}  // namespace contactbench
