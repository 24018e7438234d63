// From a wrench to a contact, with a reason: everything above put together.
//
// Contract
//   units      S frame, N, N*m, m, s.
//   locate     const and thread-safe. The same wrench and previous contact give the same answer,
//              bit for bit, whatever came before.
//   track      one stream, not thread-safe. Equal to locate with the last accepted contact as
//              `previous`, as long as that is recent; see tracking.hpp for why.
//   cost       O(log n) for a bounded pitch; no allocation but for more than four candidates.
#pragma once

#include <memory>

#include "rivals.hpp"
#include "tracking.hpp"

namespace contactbench {

class Solver {
public:
    Solver(std::shared_ptr<const Model> model, const WrenchCovariance& noise, const Gates& gates)
        : model_(std::move(model)), noise_(noise), gates_(gates), force_noise_(noise.force_bound()),
          torque_noise_(noise.torque_bound()) {}

    const Model& model() const { return *model_; }
    const WrenchCovariance& noise() const { return noise_; }
    const Gates& gates() const { return gates_; }

    // `previous`: where contact was last accepted (S, m), or null.
    Answer locate(const Wrench& w, const Vec3* previous = nullptr) const {
        const auto pruned = [&](const Query& q, double cap, Hits& hits) { search(*model_, q, cap, hits); };
        return answer(w, previous, pruned);
    }

    // The yardstick: the same answer with every candidate found without the hierarchy. (Rivals are looked
    // for as in locate: they are near misses, not candidates.)
    Answer locate_exhaustively(const Wrench& w, const Vec3* previous = nullptr) const {
        const auto all = [&](const Query& q, double cap, Hits& hits) { exhaust(*model_, q, cap, hits); };
        return answer(w, previous, all);
    }

    // `age`: seconds since the sample was taken.
    Answer track(const Wrench& w, double age = 0.0) {
        Answer a;
        track(w, age, a);
        return a;
    }

    // The same into `a`, whatever it held: a controller keeps one whose hits have room for every facet and
    // vertex and one rival, and then no sample allocates.
    void track(const Wrench& w, double age, Answer& a) {
        a.hits.clear();
        a.chosen = -1;
        a.reason = Reason::stale;
        if (age <= gates_.max_age) follow(w, a);
        if (accepted(a.reason)) {
            last_ = a.hits[std::size_t(a.chosen)].point;
            touched_ = true;
            misses_ = 0;
        } else if (touched_ && misses_ < std::numeric_limits<std::int64_t>::max()) {
            ++misses_;
        }
    }

    // The contact that `track` will follow next, or null.
    const Vec3* previous() const { return touched_ && misses_ <= gates_.recent_samples ? &last_ : nullptr; }

    void reset() {
        tracker_.reset();
        touched_ = false;
    }

private:
    // `search(query, cos_cap, hits)` finds the candidates.
    template <class Search>
    Answer answer(const Wrench& w, const Vec3* previous, Search&& search) const {
        Answer a;
        answer(w, previous, search, a);
        return a;
    }

    // `a` comes without candidates.
    template <class Search>
    void answer(const Wrench& w, const Vec3* previous, Search&& search, Answer& a) const {
        a.reason = gate(w, gates_);
        if (a.reason != Reason::ok) return;
        const Query q = make_query(model_->frame, w);
        search(q, gates_.cos_friction, a.hits);
        choose(a, gates_, w.F, previous);
        if (a.hits.size() == 0) look_past_the_cone(q, search, a);
        if (accepted(a.reason) && !model_->convex) look_for_rival(q, previous, a);
    }

    void follow(const Wrench& w, Answer& a) {
        bool covered = false;
        Query query;
        const auto find = [&](const Query& q, double cap, Hits& hits) {
            query = q;
            // The cut was made for the friction cone; past it only a search from the root will do.
            covered = cap == gates_.cos_friction && tracker_.covers(q);
            if (covered)
                search_from(tracker_.cut(), *model_, q, cap, hits);
            else
                search(*model_, q, cap, hits);
        };
        answer(w, previous(), find, a);
        if (covered) {
            tracker_.served();
        } else if (a.chosen >= 0) {
            const Candidate& c = a.hits[std::size_t(a.chosen)];
            const double turn = force_noise_ / query.force;
            const double shift = std::hypot(torque_noise_ / query.force, turn * norm(c.point)) / model_->frame.scale;
            tracker_.follow(*model_, query, gates_.cos_friction, c, turn, shift);
        }
    }

    // Nothing inside the friction cone: say whether the axis grazes the probe or misses it. On a closed mesh
    // *something* always answers: far off, a silhouette vertex all but edge-on. That is a miss, not a touch.
    template <class Search>
    static void look_past_the_cone(const Query& q, Search&& search, Answer& a) {
        constexpr double cos_miss = 0.0174524064372835;  // of 89 degrees
        search(q, cos_miss, a.hits);
        for (std::size_t i = 0; i < a.hits.size(); ++i) a.hits[i].why = Why::friction;
        if (a.hits.size() > 0) a.reason = Reason::tangential;
    }

    void look_for_rival(const Query& q, const Vec3* previous, Answer& a) const {
        Candidate& c = a.hits[std::size_t(a.chosen)];
        if (!rivals_known(q, noise_, gates_.rival_sigmas)) {
            a.reason = Reason::ambiguous;
            return;
        }
        // Nearer than what the noise of the axis may do on one patch, it is the same contact.
        const double shift = detail::rival_shift(*model_, noise_, gates_.rival_sigmas, q.force) * model_->frame.scale;
        // For one wrench |k| is inversely proportional to the cosine.
        const RivalSearch how{gates_.rival_sigmas, 2.0 * gates_.ambiguity_distance + shift,
                              std::max(gates_.cos_friction, c.cosine / gates_.torque_ratio)};
        // Contact was here a moment ago: whatever is too far away to be followed is no rival.
        const double moved = previous ? norm(c.point - *previous) : HUGE_VAL;
        if (moved + gates_.follow_distance <= how.clearance) return;
        Candidate rival;
        if (!find_rival(*model_, q, c, noise_, how, rival)) return;
        const std::int32_t mine = region_rank(c), theirs = region_rank(rival);
        const bool followed = moved <= gates_.follow_distance &&
                              norm(rival.point - *previous) > gates_.follow_distance;
        if (!followed && theirs < mine) {  // what the operator expects to touch, missed by no more than noise
            c.why = Why::region;
            rival.why = Why::chosen;
            a.chosen = std::int32_t(a.hits.size());
            a.reason = Reason::ambiguous;
        } else if (!followed) {
            a.reason = Reason::ambiguous;
        }
        a.hits.add(rival);
    }

    std::shared_ptr<const Model> model_;
    WrenchCovariance noise_;
    Gates gates_;
    double force_noise_, torque_noise_;
    Tracker tracker_;
    Vec3 last_;
    bool touched_ = false;
    std::int64_t misses_ = 0;
};

}  // namespace contactbench
