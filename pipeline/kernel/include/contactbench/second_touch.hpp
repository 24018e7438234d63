// Two touches at once: what one wrench cannot tell, time can.
//
// Two touches on one side answer like one in between: the point is then the centroid of all that touches. But while one
// touch is followed, the wrench of a second one arrives as a step, and the step by itself is a touch elsewhere. So: when
// within a moment the located point jumped, and the force grew with it, or nothing explains the wrench any more, the
// change since the moment before is located alone, with twice the covariance. If it is a touch of its own, away from the
// first, both are told, until either leaves or the change is no touch any more.
//
// Contract: S frame, N, N*m, m. Samples, not seconds: `recent_samples` of the gates is the moment. One stream; no
// allocation. A touch that slides slower than `follow_distance` in a moment is never taken for two.
#pragma once

#include "search.hpp"

namespace contactbench {

class SecondTouch {
public:
    void reset() { *this = SecondTouch(); }
    bool told() const { return told_; }

    // `a`: what was located of `w`; gets reason two_touches and `second`. `following`: a contact is being followed.
    // `alone(step, out)` locates a change of the wrench.
    template <class Alone>
    void observe(const Wrench& w, const Gates& g, bool following, Answer& a, Alone&& alone) {
        if (!(following || told_) || a.reason == Reason::low_force || a.reason == Reason::not_finite ||
            a.reason == Reason::stale || a.reason == Reason::saturated) {
            if (a.reason == Reason::low_force) reset();
            if (!following) note(w, g, a);
            return;
        }
        if (told_ && has_left(a, g)) reset();
        if (told_ || suspicious(w, g, a)) {
            if (is_second(w, g, alone)) {
                tell(a);
                return;
            }
            if (told_ && ++doubts_ <= g.recent_samples && norm(w.F - before_.wrench.F) >= least_step(g)) return;
            told_ = false;
        }
        note(w, g, a);
    }

private:
    struct Moment {
        Wrench wrench;
        Candidate touch;
        bool known = false;
    };

    // Only the second is there any more: it explains the wrench by itself.
    bool has_left(const Answer& a, const Gates& g) const {
        const Candidate* c = a.contact();
        return c && followed(a.reason, g) && norm(c->point - second_.point) <= std::max(detail::own_radius(*c, g), g.follow_distance);
    }

    static double least_step(const Gates& g) { return 2.0 * g.min_force; }

    bool suspicious(const Wrench& w, const Gates& g, const Answer& a) const {
        if (!before_.known || norm(w.F - before_.wrench.F) < least_step(g)) return false;
        const Candidate* c = a.contact();
        if (!c) return true;
        // One touch that jumped as it is does not add to the force as a second one does.
        return norm(c->point - before_.touch.point) > least_jump(g) &&
               norm(w.F) >= norm(before_.wrench.F) + g.min_force;
    }

    // A light touch is not where it seemed to be: as the force grows, its point moves by what it was uncertain.
    double least_jump(const Gates& g) const { return std::max(g.follow_distance, detail::own_radius(before_.touch, g)); }

    template <class Alone>
    bool is_second(const Wrench& w, const Gates& g, Alone&& alone) {
        if (!before_.known || norm(w.F - before_.wrench.F) < least_step(g)) return false;
        alone({w.F - before_.wrench.F, w.M - before_.wrench.M}, step_);
        const Candidate* c = step_.contact();
        if (!c || !has_point(step_.reason)) return false;
        if (!(norm(c->point - before_.touch.point) > 2.0 * std::max(detail::own_radius(*c, g), least_jump(g)))) return false;
        second_ = *c;
        told_ = true;
        doubts_ = 0;
        return true;
    }

    // Of the two, the first is given as it was: the sum of both forces may well pull at it. Figures of the whole wrench
    // stay those of one touch.
    void tell(Answer& a) const {
        Candidate& c = a.candidates[0] = before_.touch;
        c.why = Why::chosen;
        a.count = 1;
        a.chosen = 0;
        a.reason = Reason::two_touches;
        a.has_second = true;
        a.second = second_;
    }

    // The moment before is between half a moment and one old.
    void note(const Wrench& w, const Gates& g, const Answer& a) {
        if (!followed(a.reason, g)) return;
        if (!before_.known || 2 * ++age_ >= g.recent_samples) {
            before_ = next_.known ? next_ : Moment{w, *a.contact(), true};
            next_ = {w, *a.contact(), true};
            age_ = 0;
        }
    }

    Moment before_, next_;
    Candidate second_;
    Answer step_;
    std::int64_t age_ = 0, doubts_ = 0;
    bool told_ = false;
};

}  // namespace contactbench
