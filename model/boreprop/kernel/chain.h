/* A beam in sections, held at some of its supports: span by span from the bit to the last stabilizer.

   Where it is held its place is given, and its slope φ is not. Each span gives the moments at its ends as functions of
   place and slope there; that they agree from span to span is a system with three diagonals. Nothing is a small difference of
   large numbers, however many supports hold the beam, and its pivots are positive as long as the beam does not buckle. */
#ifndef BOREPROP_CHAIN_H
#define BOREPROP_CHAIN_H

#include "beam.h"

/* What acts on a beam besides being held; and, of the lines that are carried along it, under a unit of what: a slope, a
   moment and a shear at the start of a span, then the weight (g = 1) and a force of the pads. */
typedef struct {
    double g, F_rss;
} Acting;
enum { UNIT_SLOPE, UNIT_MOMENT, UNIT_SHEAR, UNIT_WEIGHT, UNIT_PADS, UNITS };

/* A linear function of what moves a span: the way from place to place, the slopes at both ends, and what acts. */
typedef struct {
    double way, start, end, g, F_rss;
} Turned;

/* A span: moment and shear at its start, and at its end. */
typedef struct {
    Turned m_start, q_start, m_end, q_end;
} Span;

/* A support: in which span it is, or at whose end, and the deflections there of the lines. */
typedef struct {
    int span;
    double v[UNITS];
} Between;

typedef struct {
    int spans;                    /* the end of the last is the last stabilizer */
    int held[MAX_PLACES + 1];     /* the support at the end of each */
    double pivot[MAX_PLACES + 1]; /* of the slope there */
    Span span[MAX_PLACES + 1];
    Between between[MAX_SUPPORTS]; /* by support */
} Chain;

/* The same function, with a part of the lines at the end of a span, m and q at its start being those of the span. */
static inline Turned turned(const Span *span, double lines[UNITS][PARTS], int part) {
    double m = lines[UNIT_MOMENT][part], q = lines[UNIT_SHEAR][part];
    const Turned *a = &span->m_start, *b = &span->q_start;
    Turned sum = {
        m * a->way + q * b->way, lines[UNIT_SLOPE][part] + m * a->start + q * b->start, m * a->end + q * b->end,
        lines[UNIT_WEIGHT][part] + m * a->g + q * b->g, lines[UNIT_PADS][part] + m * a->F_rss + q * b->F_rss
    };
    return sum;
}

/* A span that stands clamped at both ends, with the lines at its end. */
static inline void make_span(Span *span, double lines[UNITS][PARTS]) {
    const double *t = lines[UNIT_SLOPE], *b = lines[UNIT_MOMENT], *s = lines[UNIT_SHEAR], *w = lines[UNIT_WEIGHT],
                 *p = lines[UNIT_PADS];
    double determinant = clamped(b, s);
    double mv = s[SLOPE_OF_BEAM] / determinant, mf = -s[DEFLECTION] / determinant; /* m = mv Δv + mf Δφ */
    double qv = -b[SLOPE_OF_BEAM] / determinant, qf = b[DEFLECTION] / determinant;
    Turned m = {
        mv, -mv * t[DEFLECTION] - mf * t[SLOPE_OF_BEAM], mf, -mv * w[DEFLECTION] - mf * w[SLOPE_OF_BEAM],
        -mv * p[DEFLECTION] - mf * p[SLOPE_OF_BEAM]
    };
    Turned q = {
        qv, -qv * t[DEFLECTION] - qf * t[SLOPE_OF_BEAM], qf, -qv * w[DEFLECTION] - qf * w[SLOPE_OF_BEAM],
        -qv * p[DEFLECTION] - qf * p[SLOPE_OF_BEAM]
    };
    span->m_start = m, span->q_start = q;
    span->m_end = turned(span, lines, MOMENT), span->q_end = turned(span, lines, SHEAR);
}

static inline int is_held(const Beam *beam, const signed char *holds, int i) { return holds[i] || i == beam->n - 1; }

/* Hold a beam at its last stabilizer and where `holds` says so of the first `supports`; 0 if it buckles between these. Of
   supports at one place one holds it, and the others are where that is. */
static inline int make_chain(Chain *chain, const Beam *beam, int supports, const signed char *holds) {
    const Nodes *nodes = &beam->nodes;
    int at[MAX_NODES];
    double lines[UNITS][PARTS] = {{0}};
    for (int k = 0; k < nodes->count; k++) at[k] = -1;
    for (int i = supports - 1; i >= 0; i--) {
        int *own = &at[beam->node[i]];
        if (*own < 0 || is_held(beam, holds, i) || !is_held(beam, holds, *own)) *own = i;
    }
    chain->spans = 0;
    lines[UNIT_SLOPE][SLOPE_OF_BEAM] = lines[UNIT_MOMENT][MOMENT] = lines[UNIT_SHEAR][SHEAR] = 1.0;
    for (int k = 0; k < nodes->count - 1; k++) {
        if (k == beam->pads) lines[UNIT_PADS][SHEAR] += 1.0;
        if (!stands_along(nodes, k, lines[UNIT_MOMENT], lines[UNIT_SHEAR])) return 0;
        for (int unit = 0; unit < UNITS; unit++) pass_stretch(&nodes->above[k], unit == UNIT_WEIGHT, lines[unit]);
        if (!(clamped(lines[UNIT_MOMENT], lines[UNIT_SHEAR]) > 0)) return 0;
        int support = at[k + 1], last = chain->spans;
        if (support < 0) continue;
        chain->between[support].span = last;
        for (int unit = 0; unit < UNITS; unit++) chain->between[support].v[unit] = lines[unit][DEFLECTION];
        if (!is_held(beam, holds, support)) continue;
        Span *span = &chain->span[last];
        make_span(span, lines);
        chain->held[last] = support, chain->pivot[last] = span->m_end.end;
        if (last > 0) {
            chain->pivot[last - 1] -= span->m_start.start;
            const Span *before = &chain->span[last - 1];
            if (last > 1) chain->pivot[last - 1] += before->m_end.start * before->m_start.end / chain->pivot[last - 2];
            if (!(chain->pivot[last - 1] > 0)) return 0;
        }
        chain->spans++;
        memset(lines, 0, sizeof lines);
        lines[UNIT_SLOPE][SLOPE_OF_BEAM] = lines[UNIT_MOMENT][MOMENT] = lines[UNIT_SHEAR][SHEAR] = 1.0;
    }
    for (int i = 0; i < supports; i++) chain->between[i] = chain->between[at[beam->node[i]]];
    int last = chain->spans - 1;
    const Span *end = &chain->span[last];
    if (last > 0) chain->pivot[last] += end->m_end.start * end->m_start.end / chain->pivot[last - 1];
    return chain->pivot[last] > 0;
}

/* How a held beam lies: its place and slope where it is held, the forces that hold it there, and what it does to the bit. */
typedef struct {
    double v[MAX_PLACES + 2], slope[MAX_PLACES + 2]; /* at the bit, then at the end of each span */
    double m[MAX_PLACES + 1], q[MAX_PLACES + 1];     /* where each span starts */
    double F[MAX_PLACES + 1];
    double M, F_0;
} Held;

static inline double turn_of(const Turned *f, double way, double start, double end, Acting acting) {
    return f->way * way + f->start * start + f->end * end + f->g * acting.g + f->F_rss * acting.F_rss;
}

/* Find how a beam lies with the places `held.v` where it is held, and what acts on it. */
static inline void hold(const Chain *chain, Acting acting, Held *held) {
    int spans = chain->spans;
    double rest[MAX_PLACES + 1], *slope = held->slope;
    held->v[0] = slope[0] = 0.0;
    for (int k = 0; k < spans; k++) {
        const Span *span = &chain->span[k], *next = span + 1;
        double way = held->v[k + 1] - held->v[k];
        rest[k] = -turn_of(&span->m_end, way, 0.0, 0.0, acting);
        if (k + 1 < spans) rest[k] += turn_of(&next->m_start, held->v[k + 2] - held->v[k + 1], 0.0, 0.0, acting);
        if (k > 0) rest[k] -= span->m_end.start * rest[k - 1] / chain->pivot[k - 1];
    }
    for (int k = spans - 1; k >= 0; k--) {
        double above = k + 1 < spans ? chain->span[k + 1].m_start.end * slope[k + 2] : 0.0;
        slope[k + 1] = (rest[k] + above) / chain->pivot[k];
    }
    double q_end = 0.0;
    for (int k = 0; k < spans; k++) {
        const Span *span = &chain->span[k];
        double way = held->v[k + 1] - held->v[k];
        held->m[k] = turn_of(&span->m_start, way, slope[k], slope[k + 1], acting);
        held->q[k] = turn_of(&span->q_start, way, slope[k], slope[k + 1], acting);
        if (k > 0) held->F[k - 1] = held->q[k] - q_end;
        q_end = turn_of(&span->q_end, way, slope[k], slope[k + 1], acting);
    }
    held->M = -held->m[0], held->F_0 = held->q[0];
}

/* Where a support is that does not hold the beam. */
static inline double place_between(const Chain *chain, const Held *held, Acting acting, int support) {
    const Between *at = &chain->between[support];
    int k = at->span;
    return held->v[k] + at->v[UNIT_SLOPE] * held->slope[k] + at->v[UNIT_MOMENT] * held->m[k] +
           at->v[UNIT_SHEAR] * held->q[k] + at->v[UNIT_WEIGHT] * acting.g + at->v[UNIT_PADS] * acting.F_rss;
}

#endif
