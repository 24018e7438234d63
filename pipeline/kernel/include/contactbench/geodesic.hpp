// Distances along a surface from points on it, as far as a limit and no further.
//
// Method: labels at vertices, spread through facets in the order of distance as in fast marching (Kimmel &
// Sethian, PNAS 95, 1998), though only to within a 256th of the limit, which spares a heap; with the circular
// wave of Novotni & Klein (WSCG 2002): the distances of two corners place the source in the facet's plane,
// unfolded, and the third corner's distance is measured from there. That is exact where the surface unfolds
// (planes, cylinders, cones), also next to the source. A label keeps the way to its source, for edges whose
// corners were reached from different ones. A label that improves is spread again; so obtuse facets, where the
// front arrives in the wrong order, need no special edges.
//
// Contract: triangles pass `check_triangles`. Setting up is O(n + m); a run touches the facets within the limit
// and a rim of one facet around them, and allocates only while its lists grow. Not for two threads at once.
#pragma once

#include "adjacency.hpp"

namespace contactbench {

struct SurfaceMesh {
    std::vector<Vec3> vertices;
    std::vector<Triangle> faces;
    Adjacency adjacency;

    SurfaceMesh(std::vector<Vec3> points, std::vector<Triangle> triangles)
        : vertices(std::move(points)),
          faces((check_triangles(triangles, vertices.size()), std::move(triangles))),
          adjacency(faces, vertices.size()) {}

    Vec3 at(std::int32_t vertex) const { return vertices[std::size_t(vertex)]; }
    const Triangle& face(std::int32_t f) const { return faces[std::size_t(f)]; }
    Vec3 corner(std::int32_t f, std::size_t c) const { return at(face(f)[c % 3]); }
    Vec3 centroid(std::int32_t f) const { return (1.0 / 3.0) * (corner(f, 0) + corner(f, 1) + corner(f, 2)); }
};

class DistanceField {
public:
    static constexpr double unreached = std::numeric_limits<double>::infinity();

    explicit DistanceField(const SurfaceMesh& mesh)
        : mesh_(&mesh), labels_(mesh.vertices.size()), seen_(mesh.faces.size(), 0), narrow_(3 * mesh.faces.size()),
          queue_(beyond_limit + 1), next_(queue_.size()) {
        for (std::size_t h = 0; h < narrow_.size(); ++h) {
            const std::int32_t f = std::int32_t(h / 3);
            const Vec3 at = mesh.corner(f, h % 3);
            const Vec3 u = mesh.corner(f, h % 3 + 1) - at, v = mesh.corner(f, h % 3 + 2) - at;
            narrow_[h] = dot(u, v) > narrow_cosine * std::sqrt(norm2(u) * norm2(v));
        }
    }

    // Forget every label, in O(1). Runs go as far as `limit`; improvements below this share of a distance are rounding.
    void start(double limit, double rounding = 1e-9) {
        ++run_;
        limit_ = limit, rounding_ = rounding;
        touched_.clear();
    }

    // A source inside a facet; `source` tells it from others.
    void seed(std::int32_t face, Vec3 point, std::int32_t source) {
        for (std::int32_t v : mesh_->face(face)) lower(v, {norm(mesh_->at(v) - point), source, point - mesh_->at(v)});
    }

    // Spread what was seeded since the last run, through every facet that comes within the limit; but not from a vertex
    // that is further than `most` says, if it says so.
    void run(const std::vector<double>* most = nullptr) {
        for (lowest_ = 0; lowest_ < queue_.size();) {
            std::vector<std::int32_t>& level = queue_[lowest_];
            if (next_[lowest_] == level.size()) {
                level.clear();
                next_[lowest_++] = 0;
                continue;
            }
            const std::int32_t vertex = level[next_[lowest_]++];
            Label& label = labels_[std::size_t(vertex)];
            if (!label.waiting || label.turns >= most_turns) continue;
            label.waiting = false;
            if (most && label.distance > (*most)[std::size_t(vertex)]) continue;
            label.turn = ++turn_;
            ++label.turns;
            for (std::int32_t f : mesh_->adjacency.around(vertex)) spread(f, vertex, limit_);
        }
    }

    double distance(std::int32_t vertex) const {
        const Label& label = labels_[std::size_t(vertex)];
        return label.run == run_ ? label.distance : unreached;
    }

    // Of a facet's centroid, by its corners: not for the facet that holds the source.
    double centroid_distance(std::int32_t f) const {
        const Triangle& t = mesh_->face(f);
        const Vec3 centre = mesh_->centroid(f);
        double best = unreached;
        for (std::size_t c = 0; c < 3; ++c) {
            const std::int32_t a = t[c], b = t[(c + 1) % 3];
            if (distance(a) == unreached) continue;
            best = std::min(best, distance(a) + norm(centre - mesh_->at(a)));
            if (distance(b) != unreached) best = std::min(best, across(a, b, centre, unreached).distance);
        }
        return best;
    }

    bool centroid_within(std::int32_t f, double radius) const {
        const Triangle& t = mesh_->face(f);
        // The distance from one source is convex: at the centroid it is at most the corners' mean.
        const bool one_source = label(t[0]).source == label(t[1]).source && label(t[1]).source == label(t[2]).source;
        if (one_source && distance(t[0]) + distance(t[1]) + distance(t[2]) <= 3.0 * radius) return true;
        return centroid_distance(f) <= radius;
    }

    // Vertices whose label was set or lowered since they were last taken; possibly several times.
    const std::vector<std::int32_t>& touched() const { return touched_; }
    void forget_touched() { touched_.clear(); }

    // Calls visit(facet) once for each facet around the touched vertices.
    template <class Visit>
    void each_touched_facet(Visit visit) {
        ++sweep_;
        for (std::int32_t v : touched_)
            for (std::int32_t f : mesh_->adjacency.around(v)) {
                if (seen_[std::size_t(f)] == sweep_) continue;
                seen_[std::size_t(f)] = sweep_;
                visit(f);
            }
    }

private:
    // A vertex takes its turn about twice on a bad mesh; the bound on turns ends what labels that contradict each other
    // could start.
    static constexpr std::uint16_t most_turns = 1000;
    static constexpr std::size_t beyond_limit = 256;
    static constexpr double narrow_cosine = 0.17365;

    // Among sources that are closer together than corners, a corner's own may label no corner around it. The
    // line to it then passes beside the edge, over a neighbour: let it, as far as so many edges.
    static constexpr double slack = 1.0;

    struct Label {
        double distance = unreached;
        std::int32_t source = 0;
        std::uint16_t turns = 0;
        bool waiting = false;  // in the queue; entries for higher distances may be there as well
        std::uint64_t run = 0;
        std::uint64_t turn = 0, lowered = 0;  // the number of its last turn, and of the one that set its distance
        Vec3 way;  // to the source, as if the surface went on flat from here
    };

    struct Arrival {
        double distance;
        std::int32_t source;
        Vec3 way;
    };

    // An edge a-b and a target beside it, in coordinates of their plane: a is the origin, b lies along x, the
    // target has y > 0 and a source y < 0. x is in lengths of a-b, y squared.
    struct Plane {
        Vec3 ab, at;
        double length2, x, y2;

        Plane(Vec3 a, Vec3 b, Vec3 target) : ab(b - a), at(target - a), length2(norm2(ab)) {
            x = dot(at, ab) / length2;
            y2 = std::max(0.0, norm2(at) - x * x * length2);
        }
    };

    const Label& label(std::int32_t v) const { return labels_[std::size_t(v)]; }

    void lower(std::int32_t vertex, const Arrival& arrival) {
        Label& label = labels_[std::size_t(vertex)];
        if (label.run != run_) label = {unreached, 0, 0, false, run_, 0, turn_, {}};
        if (!(arrival.distance < label.distance)) return;
        if (label.distance != unreached && label.distance - arrival.distance <= rounding_ * label.distance) return;
        label.distance = arrival.distance;
        label.source = arrival.source;
        label.way = arrival.way;
        label.waiting = true;
        label.lowered = turn_;
        touched_.push_back(vertex);
        const double share = arrival.distance / limit_;
        const std::size_t place = share < 1.0 ? std::size_t(share * double(beyond_limit)) : beyond_limit;
        queue_[place].push_back(vertex);
        lowest_ = std::min(lowest_, place);
    }

    void spread(std::int32_t f, std::int32_t from, double limit) {
        const Triangle& t = mesh_->face(f);
        const std::size_t c = t[0] == from ? 0 : t[1] == from ? 1 : 2;
        const std::size_t next = c == 2 ? 0 : c + 1, last = c == 0 ? 2 : c - 1;
        reach(f, last, t[last], from, t[next], limit);
        reach(f, next, t[next], from, t[last], limit);
    }

    // Lower `target`, a corner of f, by what comes over the edge from `a`, which has a label, to `b`, which may.
    void reach(std::int32_t f, std::size_t corner, std::int32_t target, std::int32_t a, std::int32_t b, double limit) {
        const double known = distance(target);
        const Label& from = label(a);
        const Vec3 step = mesh_->at(a) - mesh_->at(target);
        const double step2 = norm2(step);
        // Nothing that comes over the edge can lower it any more: a straight line through a narrow corner makes less
        // than 80 degrees with both of its sides; if its source is further than the sides are long times
        // 1 / (2 cos 80), both ends are nearer than the corner.
        if (known <= from.distance && known * known > 9.0 * step2 && narrow_[3 * std::size_t(f) + corner]) return;
        // At b's turn this edge was looked at, unless the distance of `a` is newer.
        if (const Label& other = label(b); other.run == run_ && (other.waiting || other.turn <= from.lowered)) {
            const Arrival arrival = across(a, b, mesh_->at(target), known, limit);
            if (arrival.distance < known) return lower(target, arrival);
        }
        const double gain = known - from.distance;
        if (!(from.distance <= limit && gain > 0.0 && step2 < gain * gain)) return;
        const double length = std::sqrt(step2), end = from.distance + length;
        lower(target, {end, from.source, end / length * step});
    }

    // What arrives at `target` over the edge a-b: too late (unreached) where the straight line misses the
    // edge, where the edge is beyond the limit, and where it comes after `known`.
    Arrival across(std::int32_t a, std::int32_t b, Vec3 target, double known, double limit = unreached) const {
        const Label &la = label(a), &lb = label(b);
        if (la.source == lb.source) return circular_wave(la, lb, mesh_->at(a), mesh_->at(b), target, known, limit);
        const Plane plane(mesh_->at(a), mesh_->at(b), target);
        Arrival best = from_one(plane, la, 0.0, known, limit);
        if (const Arrival other = from_one(plane, lb, 1.0, known, limit); other.distance < best.distance) best = other;
        return best;
    }

    static Arrival circular_wave(const Label& a, const Label& b, Vec3 at_a, Vec3 at_b, Vec3 target, double known,
                                 double limit) {
        const double da2 = a.distance * a.distance, db2 = b.distance * b.distance, length2 = norm2(at_b - at_a);
        const double sx = 0.5 * ((da2 - db2) / length2 + 1.0), sy2 = std::max(0.0, da2 - sx * sx * length2);
        const double nearest2 = 0.0 <= sx && sx <= 1.0 ? sy2 : std::min(da2, db2);
        if (!(nearest2 <= limit * limit) || nearest2 >= known * known) return {unreached, a.source, {}};
        return from_source({at_a, at_b, target}, sx, sy2, known, a.source, 0.0);
    }

    // The same where only one end's label is of this source: from its way, turned into the plane.
    static Arrival from_one(const Plane& p, const Label& end, double end_x, double known, double limit) {
        const Arrival none{unreached, end.source, {}};
        if (!(end.distance <= limit) || end.distance >= known) return none;
        const double along = dot(end.way, p.ab) / p.length2, y = std::sqrt(p.y2);
        const Vec3 up = p.at - p.x * p.ab;  // of length y
        const double aside = y > 0.0 ? dot(end.way, up) / y : 0.0;
        const double flat2 = along * along * p.length2 + aside * aside, d2 = end.distance * end.distance;
        // Not from the target's side, and not bent so much that the direction is lost.
        if (aside > 0.0 || flat2 < 0.5 * d2) return none;
        const double stretch = flat2 > 0.0 ? std::sqrt(d2 / flat2) : 1.0;
        const double sy = stretch * aside;
        return from_source(p, end_x + stretch * along, sy * sy, known, end.source, slack);
    }

    // From a source at (sx, -sy), if the line passes the edge's ends by at most `beyond` edges and it is sooner
    // than `known`. Comparisons are made between squares: this is the innermost loop.
    static Arrival from_source(const Plane& p, double sx, double sy2, double known, std::int32_t source,
                               double beyond) {
        const Arrival none{unreached, source, {}};
        const double far = 1.0 + beyond;
        if (!beside(beyond + sx, p.y2, beyond + p.x, sy2) || !beside(far - sx, p.y2, far - p.x, sy2)) return none;
        const double cross = std::sqrt(p.y2 * sy2), dx = p.x - sx;
        const double d2 = dx * dx * p.length2 + p.y2 + sy2 + 2.0 * cross;
        if (!(d2 < known * known)) return none;
        const double down = p.y2 > 0.0 ? 1.0 + cross / p.y2 : 0.0;  // (y + sy) / y
        return {std::sqrt(d2), source, -(dx * p.ab + down * (p.at - p.x * p.ab))};
    }

    // Whether p sqrt(q2) + r sqrt(s2) >= 0, which is on which side of an edge's end a straight line passes.
    static bool beside(double p, double q2, double r, double s2) {
        if (p >= 0.0 && r >= 0.0) return true;
        if (p < 0.0 && r < 0.0) return false;
        const double first = p * p * q2, second = r * r * s2;
        return p >= 0.0 ? first >= second : second >= first;
    }

    const SurfaceMesh* mesh_;
    std::vector<Label> labels_;
    std::vector<std::int32_t> touched_;
    std::vector<std::uint64_t> seen_;
    std::vector<std::uint8_t> narrow_;
    std::vector<std::vector<std::int32_t>> queue_;  // by distance, in even steps up to the limit; first come, first served
    std::vector<std::size_t> next_;
    std::uint64_t run_ = 0, sweep_ = 0, turn_ = 0;
    std::size_t lowest_ = 0;
    double limit_ = 0.0, rounding_ = 0.0;
};

}  // namespace contactbench
