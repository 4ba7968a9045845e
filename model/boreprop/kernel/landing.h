/* Where a BHA whose body may touch the wall comes to lie in the hole: all its contacts, in the plane. */
#ifndef BOREPROP_LANDING_H
#define BOREPROP_LANDING_H

#include "surroundings.h"

/* Whether contacts are searched for among all supports; those of a uniform beam follow from the last ones. */
static inline int lands(const Integrator *p) { return p->scaled.stepped; }

/* Say what was in the way of contacts of a beam under an axial load, with the bit at `place`, m. */
APART static Status no_contacts(
    Code code, const Scaled *scaled, Axial axial, double force_scale, double tolerance, double place, Problem *problem
) {
    if (code != BUCKLES) return met(problem, code, code == TOO_CROWDED ? (double)MAX_WATCHED : tolerance, place);
    double most = buckling_weight(scaled, axial.cosine) * force_scale;
    wrong(problem, BUCKLES, Q_WEIGHT_ON_BIT, 0, axial.W * force_scale, most);
    return FAILED;
}

/* Whether the body stays off the wall with the contacts that follow from the last ones, which are found for it. Without an
   axial load there are no others. */
static inline int stays_off(Integrator *p, double xi, const double x[COMPONENTS], const Loads *loads) {
    Pull pull[DIRECTIONS];
    if (p->scaled.axial) return 0;
    const Mode *mode = settle(&p->modes, loads, &p->now.regime.contact);
    pull_under(p, mode, loads, pull);
    if (wall_distance(p, xi, x, pull) == 0.0) return 0;
    change_places(p, mode->contact, xi);
    return 1;
}

/* Find all contacts of a BHA whose body may touch the wall, with the bit at `xi`, where the last step ends, in the state
   `x`: anew, or from those that there are, which under an axial load may lead to others. Points that are watched stay so. */
static inline Status touch_down(Integrator *p, double xi, const double x[COMPONENTS], int anew, Problem *problem) {
    int n = p->scaled.n, points = p->scaled.points;
    const Contact *now = &p->now.regime.contact;
    Bent bent = {.end = p->modes.beam.end};
    double Y[MAX_POINTS][DIRECTIONS];
    Contact contact;
    Loads loads;
    find_loads_at(p, xi, x, force_at(&p->now, xi), &loads);
    if (stays_off(p, xi, x, &loads)) return DONE;
    bent.F_rss = loads.F_rss, bent.g = loads.g;
    memcpy(bent.e, loads.e, (size_t)n * sizeof *bent.e);
    hole_at_points(p, xi, Y);
    for (int k = 0; k < points; k++) bent.e[n + k] = x[LATERAL] - Y[k][0] - p->scaled.s[n + k] * x[ANGLE];
    Code code = search(&p->modes, &bent, points, anew ? NULL : now, &contact);
    if (code) {
        double tolerance = p->options.relative_tolerance, place = xi * p->length_scale;
        return no_contacts(code, &p->scaled, p->modes.axial, p->force_scale, tolerance, place, problem);
    }
    for (int k = 0; k < now->watched && contact.watched < MAX_WATCHED; k++)
        if (place_of(&contact, n, now->point[k]) < 0) watch(&contact, n, now->point[k], 0);
    change_places(p, contact, xi);
    return DONE;
}

#endif
