/* One step of the integrator: a stretch of the run on which the state is a polynomial. */
#ifndef BOREPROP_STEP_H
#define BOREPROP_STEP_H

#include "frame.h"
#include "radau.h"
#include "system.h"

enum { NONE = -1 }; /* no event */

/* A stretch [xi, end] of the run: the state as polynomials in t = (ξ − xi)/h, and the event at its end, if any. */
typedef struct {
    double xi, h, x[COMPONENTS][S + 1], end;
    double path[AXES]; /* from the start of the run to xi: sideways and down; in space north, east and down */
    int event, side;   /* the part whose bound is met at the end, and on which side */
    double next_h;     /* length planned for the next step */
#ifdef SPACE
    Frame frame; /* at xi */
#endif
} Step;

/* A range of inclinations. */
typedef struct {
    double low, high;
} Range;

#ifdef SPACE
/* Whatever the law in space says at one place. */
typedef struct {
    double rate[COMPONENTS], by[COMPONENTS][COMPONENTS]; /* θ⃗' and Θ⃗, and their derivatives by the state */
    double M[DIRECTIONS], F_0[DIRECTIONS], psi[DIRECTIONS], G[DIRECTIONS], F_rss[DIRECTIONS], eta_pi, psi_star;
    double q[MAX_PLACES][DIRECTIONS]; /* of the support at each place; the others by number among those in contact */
    double v[MAX_PLACES][DIRECTIONS], F[MAX_PLACES][DIRECTIONS];
} Reply;
#endif

/* The error, over the tolerance, of a step that is not solved: the next is a third as long, behind a kink a tenth. */
#define TOO_HARD 100.0

/* A step as the collocation gives it, before events cut it, with values at its points. */
typedef struct {
    Step step;
    int follows; /* on the last one, among layers, so that this tells where it leads */
    int passes;  /* kinks, of which there are many */
    double delayed[MAX_PLACES][DIRECTIONS][POINTS]; /* the hole's lateral coordinate at ξ − s_i */
    double x[COMPONENTS][POINTS];
    double sines[POINTS],
        ahead[POINTS]; /* the sine that goes with the weight; distance from where the inputs were taken over */
    double error;      /* estimated, over the tolerance */
#ifdef SPACE
    Reply at[POINTS];
#endif
} Trial;

/* The weight of the error of θ in that of a step. In space it is more: the largest errors of a run were those of θ within its
   steps, and with three times the weight they are half as large, for one trial in eight. */
#define HEAVIER 3.0
static inline double weight_of_theta(const Options *options) {
    return DIRECTIONS > 1 ? HEAVIER * options->theta_weight : options->theta_weight;
}

static inline double polynomial(const double c[S + 1], double t) {
    return c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * (c[4] + t * c[5]))));
}

static inline double polynomial_slope(const double c[S + 1], double t) {
    return c[1] + t * (2 * c[2] + t * (3 * c[3] + t * (4 * c[4] + t * 5 * c[5])));
}

/* The state at `xi`. */
static inline void step_state(const Step *step, double xi, double x[COMPONENTS]) {
    double t = (xi - step->xi) / step->h;
    for (int c = 0; c < COMPONENTS; c++) x[c] = polynomial(step->x[c], t);
}

/* A derivative of one component at `xi`. */
static inline double step_derivative(const Step *step, int component, int order, double xi) {
    double t = (xi - step->xi) / step->h, value = 0.0, power = 1.0;
    for (int m = S; m >= order; m--) {
        double factor = 1.0;
        for (int k = 0; k < order; k++) factor *= m - k;
        value = value * t + factor * step->x[component][m];
    }
    for (int k = 0; k < order; k++) power *= step->h;
    return value / power;
}

/* The largest jump at `xi` in a derivative of the hole's lateral coordinates, from one step to the next. */
static inline double step_jump(const Step *before, const Step *after, int order, double xi) {
    double jump = 0.0;
    for (int c = LATERAL; c < COMPONENTS; c++)
        jump = larger(jump, fabs(step_derivative(after, c, order, xi) - step_derivative(before, c, order, xi)));
    return jump;
}

#endif
