/* The supports of a contact problem in space, and how far each gives way to a force. */
#ifndef BOREPROP_TOUCHING_H
#define BOREPROP_TOUCHING_H

#include "modes.h"

enum { MOST_TOUCHING = 2 * MAX_PLACES }; /* numbers: two for each support in contact */

/* The places of those that touch, C, and what belongs to them. */
typedef struct {
    int touching, C[MAX_PLACES], support[MAX_PLACES];
    double k[MAX_PLACES], y[MAX_PLACES];  /* by number in C; k is what each yields alone, … */
    double K_inv[MAX_PLACES][MAX_PLACES]; /* of those in C */
} Touching;

static inline Touching touching_of(const Modes *modes, const Contact *contact) {
    Touching touching;
    int n = modes->beam.n, m = 0;
    for (int i = 0; i < place_count(*contact, n); i++)
        if (contact->of[i]) touching.C[m] = i, touching.support[m++] = support_at(contact, n, i);
    touching.touching = m;
    for (int a = 0; a < m; a++) {
        touching.y[a] = modes->y_star[touching.support[a]];
        for (int b = 0; b < m; b++)
            touching.K_inv[a][b] = compliance(&modes->beam, touching.support[a], touching.support[b]);
        touching.k[a] = touching.K_inv[a][a];
    }
    return touching;
}

#define LEAST_YIELD 1e-9 /* over K⁻¹_ii: rounding may take all where supports are close together */

/* … or while the others stay: one over the diagonal of the inverse of K⁻¹. */
static inline void find_yields(Touching *of) {
    int m = of->touching;
    Symmetric matrix;
    matrix.size = m;
    for (int a = 0; a < m; a++) memcpy(matrix.row[a], of->K_inv[a], (size_t)m * sizeof(double));
    eliminate_symmetric(&matrix);
    for (int a = 0; a < m; a++) {
        double x[MOST_TOUCHING] = {0}, own = of->K_inv[a][a];
        x[a] = 1.0;
        solve_symmetric(&matrix, x);
        of->k[a] = x[a] > 0 ? smaller(own, larger(1 / x[a], LEAST_YIELD * own)) : LEAST_YIELD * own;
    }
}

#endif
