/* The beam as it is built: sections of their own stiffness and weight, under axial load, in the paper's numbers.

   With β(s) = EI(s)/EI_1, EI_1 that of the section at the bit, and the tension N(s) = −W + cos α ∫₀ˢ w ds:

       (βv''/3)'' − (Nv')' = −w g + point loads ,   v(0) = v'(0) = 0 ,   v(λ) given ,   v''(λ) = 0

   where v is the distance from the bit's axis. It is solved as an initial value problem from the bit on, for the line
   (v, v', m, q) with m = βv''/3 and q = m' − Nv', so that −m(0) is the moment M and q(0) the force F_0 at the bit. */
#ifndef BOREPROP_ASSEMBLY_H
#define BOREPROP_ASSEMBLY_H

#include "system.h"

enum { DEFLECTION, SLOPE_OF_BEAM, MOMENT, SHEAR, PARTS }; /* the parts of a line, and how many there are */
enum { MAX_NODES = MAX_SUPPORTS + MAX_SECTIONS + 2 };

/* A uniform stretch of beam from one node to the next: the line at its end is `of` times that at its start, plus `load`
   times g. */
typedef struct {
    double of[PARTS][PARTS], load[PARTS];
} Stretch;

/* How hard the beam is pressed: the weight on the bit W over F*, and the cosine of the inclination at which the buoyant
   weight acts along it. Both are zero if the axial load is left out. */
typedef struct {
    double W, cosine;
} Axial;

/* The nodes of a beam: the bit, and what bends it or changes along it. Between two of them it is uniform. */
typedef struct {
    int count;
    double cosine; /* of the inclination at which the weight acts along the beam */
    double s[MAX_NODES], beta[MAX_NODES], w[MAX_NODES], N[MAX_NODES]; /* β and w above the node; N at it */
    Stretch above[MAX_NODES];                                         /* to the next node */
} Nodes;

enum { TERMS = 24 }; /* of the series over a stretch on which 3|N|h²/β is at most 1: those left out are below 1e-20 */

/* Carry a line over a length h of uniform beam with the tension N + rise t, by its power series in t. */
static inline void carry(double h, double beta, double N, double rise, double load, double line[PARTS]) {
    double slope[TERMS + 1] = {line[SLOPE_OF_BEAM]}, moment[TERMS + 1] = {line[MOMENT]}; /* coefficients times h^k */
    double shear[2] = {line[SHEAR], load * h};
    int terms = N == 0.0 && rise == 0.0 ? 3 : TERMS; /* the others are zero then */
    for (int k = 0; k < terms; k++) {
        double q = k < 2 ? shear[k] : 0.0, before = k ? slope[k - 1] * h : 0.0;
        slope[k + 1] = 3 / beta * moment[k] * h / (k + 1);
        moment[k + 1] = (q + N * slope[k] + rise * before) * h / (k + 1);
    }
    line[SLOPE_OF_BEAM] = line[MOMENT] = 0.0;
    for (int k = terms; k >= 0; k--) {
        line[DEFLECTION] += slope[k] * h / (k + 1);
        line[SLOPE_OF_BEAM] += slope[k], line[MOMENT] += moment[k];
    }
    line[SHEAR] += shear[1];
}

/* In how many parts a line is carried from node k on over a length. */
static inline int part_count(const Nodes *nodes, int k, double length) {
    double N = nodes->N[k], end = N + nodes->w[k] * nodes->cosine * length;
    return 1 + (int)smaller(length * sqrt(3 * larger(fabs(N), fabs(end)) / nodes->beta[k]), 1e4);
}

/* Carry a line from node k on, not beyond the next, under the weight times g. */
static inline void carry_from(const Nodes *nodes, int k, double length, double g, double line[PARTS]) {
    double beta = nodes->beta[k], w = nodes->w[k], rise = w * nodes->cosine;
    int parts = part_count(nodes, k, length);
    double h = length / parts;
    for (int part = 0; part < parts; part++) carry(h, beta, nodes->N[k] + rise * (part * h), rise, -w * g, line);
}

/* The stretch above node k. */
static inline Stretch stretch_above(const Nodes *nodes, int k) {
    Stretch stretch;
    double length = nodes->s[k + 1] - nodes->s[k];
    for (int column = 0; column <= PARTS; column++) { /* the last one bears the weight */
        double line[PARTS] = {0};
        if (column < PARTS) line[column] = 1.0;
        carry_from(nodes, k, length, column == PARTS, line);
        for (int i = 0; i < PARTS; i++) *(column < PARTS ? &stretch.of[i][column] : &stretch.load[i]) = line[i];
    }
    return stretch;
}

/* Add a node at `s`, unless there is one. */
static inline void add_node(Nodes *nodes, double s) {
    int k = nodes->count;
    while (k > 0 && nodes->s[k - 1] > s) k--;
    if (k > 0 && nodes->s[k - 1] == s) return;
    memmove(nodes->s + k + 1, nodes->s + k, (size_t)(nodes->count - k) * sizeof *nodes->s);
    nodes->s[k] = s;
    nodes->count++;
}

/* The node at `s`, which is one of them. */
static inline int node_at(const Nodes *nodes, double s) {
    int k = 0;
    while (nodes->s[k] < s) k++;
    return k;
}

/* The nodes of a beam and the stretches between them. */
static inline void make_nodes(Nodes *nodes, const Scaled *scaled, Axial axial) {
    double end = scaled->s[scaled->n - 1];
    int section = 0;
    nodes->count = 0, nodes->cosine = axial.cosine;
    add_node(nodes, 0.0);
    add_node(nodes, scaled->Delta);
    for (int i = 0; i < scaled->n + scaled->points; i++) add_node(nodes, scaled->s[i]);
    for (int k = 0; k < scaled->sections; k++)
        if (scaled->section_end[k] < end) add_node(nodes, scaled->section_end[k]);
    nodes->N[0] = -axial.W;
    for (int k = 0; k < nodes->count; k++) {
        while (section < scaled->sections - 1 && scaled->section_end[section] <= nodes->s[k]) section++;
        nodes->beta[k] = scaled->section_beta[section], nodes->w[k] = scaled->section_w[section];
        if (k > 0) {
            nodes->N[k] = nodes->N[k - 1] + axial.cosine * nodes->w[k - 1] * (nodes->s[k] - nodes->s[k - 1]);
            nodes->above[k - 1] = stretch_above(nodes, k - 1);
        }
    }
}

/* Carry a line over a stretch, under the weight times g. */
static inline void pass_stretch(const Stretch *stretch, double g, double line[PARTS]) {
    double start[PARTS];
    memcpy(start, line, sizeof start);
    for (int i = 0; i < PARTS; i++) line[i] = dot(PARTS, stretch->of[i], start) + g * stretch->load[i];
}

/* Of the lines under a unit moment and a unit shear at the start of a span: positive as long as one that ends where they are
   does not buckle, clamped at both ends. It is zero where it buckles in any of its modes, one further on than the other. */
static inline double clamped(const double bent[PARTS], const double sheared[PARTS]) {
    return bent[DEFLECTION] * sheared[SLOPE_OF_BEAM] - sheared[DEFLECTION] * bent[SLOPE_OF_BEAM];
}

/* Whether a span, with these lines at node k, stands clamped wherever it may end before the next node: two modes are more
   than two parts apart. */
static inline int stands_along(const Nodes *nodes, int k, const double bent[PARTS], const double sheared[PARTS]) {
    double length = nodes->s[k + 1] - nodes->s[k];
    int parts = part_count(nodes, k, length);
    for (int part = 1; part < parts; part++) {
        double lines[2][PARTS];
        memcpy(lines[0], bent, sizeof lines[0]), memcpy(lines[1], sheared, sizeof lines[1]);
        for (int i = 0; i < 2; i++) carry_from(nodes, k, length * part / parts, 0.0, lines[i]);
        if (!(clamped(lines[0], lines[1]) > 0)) return 0;
    }
    return 1;
}

/* Whether the beam stands: with every stabilizer held it does not buckle.

   Each span clamped at both ends must stand, which shows as a positive determinant all along it, and so must the turning
   of the beam at the stabilizers, whose stiffness is a matrix with three diagonals. */
static inline int stands(const Scaled *scaled, Axial axial) {
    Nodes nodes;
    double pivot = INFINITY, coupling = 0.0, held = 0.0; /* held: the stiffness that the span before gives its end */
    int k = 0;
    make_nodes(&nodes, scaled, axial);
    for (int i = 0; i < scaled->n; i++) {
        double turned[PARTS] = {0, 1, 0, 0}, bent[PARTS] = {0, 0, 1, 0}, sheared[PARTS] = {0, 0, 0, 1},
               determinant = 0.0;
        for (; nodes.s[k] < scaled->s[i]; k++) {
            if (!stands_along(&nodes, k, bent, sheared)) return 0;
            pass_stretch(&nodes.above[k], 0.0, turned);
            pass_stretch(&nodes.above[k], 0.0, bent);
            pass_stretch(&nodes.above[k], 0.0, sheared);
            determinant = clamped(bent, sheared);
            if (!(determinant > 0)) return 0;
        }
        /* moments at both ends under a unit turn of the start, and at the end under a unit turn of it */
        double moment =
            (sheared[DEFLECTION] * turned[SLOPE_OF_BEAM] - turned[DEFLECTION] * sheared[SLOPE_OF_BEAM]) / determinant;
        double shear =
            (turned[DEFLECTION] * bent[SLOPE_OF_BEAM] - bent[DEFLECTION] * turned[SLOPE_OF_BEAM]) / determinant;
        if (i > 0) {
            pivot = held - moment - (i > 1 ? coupling * coupling / pivot : 0.0);
            if (!(pivot > 0)) return 0;
        }
        coupling = turned[MOMENT] + moment * bent[MOMENT] + shear * sheared[MOMENT];
        held = (bent[DEFLECTION] * sheared[MOMENT] - sheared[DEFLECTION] * bent[MOMENT]) / determinant;
    }
    return held - (scaled->n > 1 ? coupling * coupling / pivot : 0.0) > 0;
}

#define LIGHTEST 1e-3 /* of β/λ²: under so little weight any beam stands that stands under its own */

/* The weight on the bit at which the beam buckles though every stabilizer is held, over F*: what it carries is less. */
static inline double buckling_weight(const Scaled *scaled, double cosine) {
    double reach = scaled->s[scaled->n - 1], low = 0.0, high = LIGHTEST / (reach * reach);
    Axial axial = {0.0, cosine};
    if (!stands(scaled, axial)) return 0.0;
    for (axial.W = high; stands(scaled, axial); axial.W = high *= 2) low = high;
    while (high - low > 1e-9 * high) {
        axial.W = (low + high) / 2;
        if (stands(scaled, axial)) low = axial.W;
        else high = axial.W;
    }
    return low;
}

/* How the beam answers a load: moment and shear of its line at the bit. */
typedef struct {
    double m, q;
} Answer;

/* The answer that brings the end of the beam to the hole without a moment, where the load alone has brought it to this
   deflection and moment; `bent` and `sheared` are there under a unit moment and a unit shear at the bit. */
static inline Answer answer_to(
    const double bent[PARTS], const double sheared[PARTS], double deflection, double moment
) {
    double determinant = bent[DEFLECTION] * sheared[MOMENT] - sheared[DEFLECTION] * bent[MOMENT];
    Answer answer = {
        (sheared[DEFLECTION] * moment - deflection * sheared[MOMENT]) / determinant,
        (deflection * bent[MOMENT] - bent[DEFLECTION] * moment) / determinant,
    };
    return answer;
}

/* What of a line at the upper end of a stretch is asked for, as functions of the line at its lower end. */
static inline void look_down(const Stretch *stretch, double asked[2][PARTS]) {
    double above[2][PARTS];
    memcpy(above, asked, sizeof above);
    for (int row = 0; row < 2; row++)
        for (int j = 0; j < PARTS; j++) {
            asked[row][j] = 0.0;
            for (int i = 0; i < PARTS; i++) asked[row][j] += above[row][i] * stretch->of[i][j];
        }
}

#endif
