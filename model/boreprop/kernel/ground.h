/* What the bit meets along the way: layers of rock by true vertical depth, and the wear of the bit, as in ground.py. */
#ifndef BOREPROP_GROUND_H
#define BOREPROP_GROUND_H

#include "events.h"

#define STAY 0.01          /* m: a bit that has met a layer drills so far in it at least */
#define AT_TOP 1e-9        /* m: a bit this little beyond the bound of a layer, by rounding, is at it */
#define LEAST_LEFT 1e-3    /* of the weight that wear flats bear is left as active weight, at least */
#define ROUNDED 1e-12      /* relative: a length so little before that of a change is at it */
#define UPRIGHT_ENOUGH 1.5 /* rad: an inclination up to which the bit goes down, somewhat less than a right angle */
enum { LOOKS = 4 };        /* of a step, at whose ends the depth is looked at */
enum { ROCK = 3 };         /* η, χ, ψ* */

/* Layers are numbered from the top; the first one, 0, has no top of its own. Without numbers there is nothing of this. */
typedef struct {
    int there, layers;  /* whether there is anything; how many tops */
    const double *own;  /* rock that is given unless somebody gives other: for it layers stand in */
    const double *tops; /* m below the bit at the start, increasing */
    const double *rock; /* ROCK values in each layer; 0 where what is given holds */
    double weight_per_metre, largest_weight; /* that wear flats bear, N/m and N; 0 if the bit stays sharp */
} Ground;

/* How many numbers a ground of so many tops is made of. */
static inline Count ground_size(int layers) { return ROCK + 2 + layers + ROCK * ((Count)layers + 1); }

/* The ground that is made of numbers, which must live on: own, the two of the wear, tops, rock; NULL: none. */
static inline Ground ground_of(int layers, const double *numbers) {
    Ground ground = {0};
    if (!numbers) return ground;
    const double *tops = numbers + ROCK + 2;
    Ground made = {1, layers, numbers, tops, tops + layers, numbers[ROCK], numbers[ROCK + 1]};
    return made;
}

/* The layer in which the bit starts. */
static inline int first_layer(const Ground *ground) {
    int layer = 0;
    while (layer < ground->layers && ground->tops[layer] <= 0) layer++;
    return layer;
}

/* Depths below the start between which a layer lies, m. */
static inline double layer_top(const Ground *ground, int layer) { return layer ? ground->tops[layer - 1] : -INFINITY; }
static inline double layer_bottom(const Ground *ground, int layer) {
    return layer < ground->layers ? ground->tops[layer] : INFINITY;
}

/* Whether a layer stands in for property k of the rock, of which this value is given. */
static inline int stands_in(const Ground *ground, int layer, int k, double given) {
    return ground->there && ground->rock[ROCK * layer + k] != 0 && given == ground->own[k];
}

/* The rock in a layer where these inputs are given; for a property that changes along the way no layer stands in. */
static inline Inputs rock_in(const Ground *ground, int layer, Inputs given) {
    double *own[ROCK] = {&given.lateral_steering_resistance, &given.angular_steering_resistance, &given.bit_tilt_limit};
    double slope[ROCK] = {
        given.lateral_steering_resistance_slope, given.angular_steering_resistance_slope, given.bit_tilt_limit_slope
    };
    for (int k = 0; k < ROCK; k++)
        if (slope[k] == 0 && stands_in(ground, layer, k, *own[k])) *own[k] = ground->rock[ROCK * layer + k];
    return given;
}

/* The inputs a length `way`, m, ahead of where these are given. */
static inline Inputs given_ahead(Inputs given, double way) {
    given.rss_force += given.rss_force_slope * way;
    given.active_weight_on_bit += given.active_weight_on_bit_slope * way;
    given.lateral_steering_resistance += given.lateral_steering_resistance_slope * way;
    given.angular_steering_resistance += given.angular_steering_resistance_slope * way;
    given.bit_tilt_limit += given.bit_tilt_limit_slope * way;
    return given;
}

/* Let the active weight be what wear leaves of it where `length` is drilled, on a way to `end`: gives up to which drilled
   length it goes on so; 0, and the problem, if before that the wear flats bear all of it. */
static inline int wear_off(
    const Ground *ground, double length, double end, Inputs *inputs, double *until, Problem *problem
) {
    double *weight = &inputs->active_weight_on_bit, *slope = &inputs->active_weight_on_bit_slope;
    double per_metre = ground->weight_per_metre, blunt = per_metre * length, worn = ground->largest_weight / per_metre;
    *until = INFINITY;
    if (per_metre == 0) return 1;
    if (length < worn * (1 - ROUNDED)) *until = worn, *slope -= per_metre;
    else blunt = ground->largest_weight;
    *weight -= blunt;
    double least = LEAST_LEFT * blunt;
    if (*weight > least && *weight + *slope * (smaller(end, *until) - length) > least) return 1;
    met(problem, WORN_OUT, blunt, *weight <= least ? length : length - *weight / *slope);
    return 0;
}

/* How far down the bit goes from the start of a Step. */
static inline double way_down(const void *step, double xi) {
    double path[AXES] = {0};
    move_along(step, xi, path);
    return path[AXES - 1];
}

/* How inclined the hole is along a step, at least and at most, as far as a bound of its polynomial shows; in the plane. */
static inline Range inclination_of(const Step *step) {
    const double *Y = step->x[LATERAL];
    double turn = 0.0, start = fabs(Y[1]);
    for (int m = 2; m <= S; m++) turn += m * fabs(Y[m]);
    Range range = {larger(start - turn, 0.0) / step->h, (start + turn) / step->h};
    if (DIRECTIONS > 1) range.low = 0.0, range.high = INFINITY;
    return range;
}

/* Where between two samples the bit passes a depth, by secants, which nearly straight ways need few of: the error of one is
   about the product of what the last two moved. Where they leave the way between, by `crossing`, slower. */
static inline double passing(const Step *step, double limit, int side, Sample from, Sample to) {
    Sample before = from, at = to;
    for (int k = 0; k < MOST_TRIES; k++) {
        double moved = at.xi - before.xi, next = at.xi + (limit - at.value) * moved / (at.value - before.value);
        if (!(next >= from.xi && next <= to.xi)) break;
        if (fabs((next - at.xi) * moved) < CLOSE) return next;
        before = at, at.xi = next, at.value = way_down(step, next);
    }
    double f_from = side * (from.value - limit), f_to = side * (to.value - limit);
    return crossing(way_down, step, limit, side, from.xi, to.xi, f_from, f_to);
}

/* Where the bit first is outside of its layer along a step, from `begin` on; on which side, 1 below, −1 above, or 0 if
   nowhere. The step starts at `depth`, and the layer lies between `top` and `bottom`, in the unit of the step. */
static inline int first_exit(const Step *step, double depth, double top, double bottom, double begin, double *where) {
    Range inclined = inclination_of(step);
    int falls = inclined.high < UPRIGHT_ENOUGH;
    const int looks = falls ? 1 : LOOKS; /* where the bit only goes down its end shows it */
    double way = step->end - step->xi, part = (step->end - begin) / looks, found[LOOKS];
    Sample samples[2 * LOOKS + 2];
    int count = 0;
    top -= depth, bottom -= depth;
    if (begin > step->end || (-way > top && way < bottom)) return 0; /* a path is no deeper than long */
    double square = inclined.low * inclined.low; /* and if it is inclined less deep: cos Θ <= 1 − Θ²/2 + Θ⁴/24 */
    if (falls && top <= CLOSE && way * (1 - square / 2 * (1 - square / 12)) < bottom) return 0;
    for (int k = 0; k <= looks; k++) {
        double xi = k < looks ? begin + k * part : step->end;
        Sample at = {xi, xi > step->xi ? way_down(step, xi) : 0.0};
        samples[count++] = at;
    }
    int turns = step->end > begin ? extremes(samples, count, found) : 0;
    for (int k = 0; k < turns; k++) {
        Sample turn = {found[k], way_down(step, found[k])};
        if (found[k] > begin) insert(samples, &count, turn);
    }
    for (int k = 0; k < count; k++) {
        int side = samples[k].value > bottom ? 1 : samples[k].value < top ? -1 : 0;
        if (!side) continue;
        *where = k ? passing(step, side > 0 ? bottom : top, side, samples[k - 1], samples[k]) : samples[0].xi;
        return side;
    }
    return 0;
}

#endif
