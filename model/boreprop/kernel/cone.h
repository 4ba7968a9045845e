/* Contact in space: a stabilizer i whose offset δ_i from the axis of the hole lies within a disc |δ_i| <= y*_i, and which
   the wall pushes towards the axis. F minimises ½ Fᵀ(K⁻¹ ⊗ I)F + q̃·F + Σ y*_i |F_i|, so it is unique.

   With k_i = K⁻¹_ii and v_i = δ_i − k_i F_i, the offset is the point of the disc that is nearest to v_i:

       in contact  δ_i = y*_i v_i/|v_i| ,   F_i = −(v_i − δ_i)/k_i ,   |v_i| >= y*_i ;        free  δ_i = v_i ,   F_i = 0

   and v_i = q̃_i + Σ_{j≠i} K⁻¹_ij F_j . Within a regime this is smooth, and solved by Newton's method. */
#ifndef BOREPROP_CONE_H
#define BOREPROP_CONE_H

#include "modes.h"

enum { TOUCHES = -1 };                        /* the contact beyond the bound of a free offset, as `change` has it */
enum { MOST_TOUCHING = 2 * MAX_STABILIZERS }; /* numbers: two for each stabilizer in contact */

/* The direction of a vector whose length is known to be at least `least` while its regime holds: a function w of the
   square of the length, which is one over the length from REACHED of that on, and a series in the square below, so that it
   stays smooth where a trial step goes too far. Gives w, and twice its derivative. */
#define REACHED 0.7
static inline void direction_factors(double square, double least, double *w, double *bend) {
    double inner = REACHED * least, from = inner * inner;
    if (square >= from) {
        *w = 1 / sqrt(square), *bend = -*w / square;
        return;
    }
    double t = 1 - square / from; /* (1 − t)^(−1/2) about t = 0 */
    *w = (1 + t * (1.0 / 2 + t * (3.0 / 8 + t * (5.0 / 16 + t * (35.0 / 128))))) / inner;
    *bend = -2 * (1.0 / 2 + t * (3.0 / 4 + t * (15.0 / 16 + t * (35.0 / 32)))) / (inner * from);
}

/* What the wall takes of v: v less the nearest point of the disc of radius y, and its derivative by v, row by row. */
static inline void beyond_disc(const double v[2], double y, double beyond[2], double slope[2][2]) {
    double w = 0.0, bend = 0.0;
    if (y > 0) direction_factors(v[0] * v[0] + v[1] * v[1], y, &w, &bend);
    for (int d = 0; d < 2; d++) {
        beyond[d] = v[d] - y * w * v[d];
        for (int c = 0; c < 2; c++) slope[d][c] = (d == c) * (1 - y * w) - y * bend * v[d] * v[c];
    }
}

/* Solve a system of up to MOST_TOUCHING equations, row by row in `matrix`, for several right sides, which lie behind it in
   each row and become the solutions. Returns 0 if it is singular. */
static inline int solve_touching(int size, int sides, double matrix[MOST_TOUCHING][2 * MOST_TOUCHING + 1]) {
    for (int column = 0; column < size; column++) {
        int pivot = column;
        for (int i = column + 1; i < size; i++)
            if (fabs(matrix[i][column]) > fabs(matrix[pivot][column])) pivot = i;
        if (!(fabs(matrix[pivot][column]) > 0)) return 0;
        double divisor = matrix[pivot][column];
        for (int j = column; j < size + sides; j++) {
            double value = matrix[pivot][j];
            matrix[pivot][j] = matrix[column][j];
            matrix[column][j] = value / divisor;
        }
        for (int i = 0; i < size; i++) {
            double factor = matrix[i][column];
            if (i == column || factor == 0.0) continue;
            for (int j = column; j < size + sides; j++) matrix[i][j] -= factor * matrix[column][j];
        }
    }
    return 1;
}

/* The supports of a contact problem: which of the non-ideal stabilizers touch, C, and what belongs to them. */
typedef struct {
    int touching, C[MAX_STABILIZERS];
    double k[MAX_STABILIZERS], y[MAX_STABILIZERS];  /* by number in C */
    double K_inv[MAX_STABILIZERS][MAX_STABILIZERS]; /* of those in C */
} Touching;

static inline Touching touching_of(const Modes *modes, Contact contact) {
    Touching touching = {0};
    for (int i = 0; i < modes->beam.n - 1; i++)
        if (contact.of[i]) touching.C[touching.touching++] = i;
    for (int a = 0; a < touching.touching; a++) {
        touching.y[a] = modes->y_star[touching.C[a]];
        touching.k[a] = compliance(&modes->beam, touching.C[a], touching.C[a]);
        for (int b = 0; b < touching.touching; b++)
            touching.K_inv[a][b] = compliance(&modes->beam, touching.C[a], touching.C[b]);
    }
    return touching;
}

#define SAME_OFFSET 1e-14 /* relative: so near to the solution no correction brings v nearer */
enum { MOST_CORRECTIONS = 25 };

/* The v of those that touch under their q̃, from a guess in `v`; returns 0 if none is found. Where `answer` is given, it
   becomes dF/dq̃, row by row, over the directions of each of those that touch. */
static inline int solve_contacts(
    const Touching *of, double q[MAX_STABILIZERS][2], double v[MAX_STABILIZERS][2], double F[MAX_STABILIZERS][2],
    double answer[MOST_TOUCHING][MOST_TOUCHING]
) {
    int m = of->touching, size = 2 * m, found = 0;
    double beyond[MAX_STABILIZERS][2], slope[MAX_STABILIZERS][2][2];
    double matrix[MOST_TOUCHING][2 * MOST_TOUCHING + 1];
    if (m == 1) v[0][0] = q[0][0], v[0][1] = q[0][1];
    for (int correction = 0; !found; correction++) {
        double change = 0.0, scale = 0.0;
        for (int a = 0; a < m; a++) beyond_disc(v[a], of->y[a], beyond[a], slope[a]);
        if (m <= 1) break;
        if (correction == MOST_CORRECTIONS) return 0;
        for (int a = 0; a < m; a++)
            for (int d = 0; d < 2; d++) {
                double *row = matrix[2 * a + d];
                row[size] = q[a][d] - v[a][d];
                for (int b = 0; b < m; b++) {
                    double share = a == b ? 0.0 : of->K_inv[a][b] / of->k[b];
                    row[size] -= share * beyond[b][d];
                    for (int c = 0; c < 2; c++) row[2 * b + c] = a == b ? d == c : share * slope[b][d][c];
                }
            }
        if (!solve_touching(size, 1, matrix)) return 0;
        for (int a = 0; a < m; a++)
            for (int d = 0; d < 2; d++) {
                double by = matrix[2 * a + d][size];
                v[a][d] += by;
                change = larger(change, fabs(by)), scale = larger(scale, larger(fabs(v[a][d]), of->y[a]));
            }
        if (!isfinite(change)) return 0;
        found = change <= 1e-8 * scale; /* the next change is below rounding */
        if (found)
            for (int a = 0; a < m; a++) beyond_disc(v[a], of->y[a], beyond[a], slope[a]);
    }
    for (int a = 0; a < m; a++)
        for (int d = 0; d < 2; d++) F[a][d] = -beyond[a][d] / of->k[a];
    if (!answer) return 1;
    for (int a = 0; a < m; a++)
        for (int d = 0; d < 2; d++) {
            double *row = matrix[2 * a + d];
            for (int b = 0; b < m; b++) {
                double share = a == b ? 0.0 : of->K_inv[a][b] / of->k[b];
                for (int c = 0; c < 2; c++) row[2 * b + c] = a == b ? d == c : share * slope[b][d][c];
            }
            for (int j = 0; j < size; j++) row[size + j] = j == 2 * a + d;
        }
    if (m > 1 && !solve_touching(size, size, matrix)) return 0;
    for (int a = 0; a < m; a++)
        for (int d = 0; d < 2; d++)
            for (int j = 0; j < size; j++) {
                double by = slope[a][d][0] * matrix[2 * a][size + j] + slope[a][d][1] * matrix[2 * a + 1][size + j];
                answer[2 * a + d][j] = -by / of->k[a];
            }
    return 1;
}

/* Whether v lies beyond the disc, so that the stabilizer touches; without clearance it always does. */
static inline int is_beyond(const double v[2], double y) { return y == 0.0 || hypot(v[0], v[1]) > y; }

enum { MOST_ROUNDS = 60, SWEEPS = 8, LAST_SWEEPS = 20000 };

/* How far v is from a solution over all stabilizers, at most; gives where each ought to be for the others. */
static inline double off_balance(
    const Modes *modes, double q[MAX_STABILIZERS][2], double v[MAX_STABILIZERS][2], double wanted[MAX_STABILIZERS][2]
) {
    int count = modes->beam.n - 1;
    double off = 0.0;
    for (int i = 0; i < count; i++) memcpy(wanted[i], q[i], sizeof wanted[i]);
    for (int j = 0; j < count; j++) {
        double beyond[2], slope[2][2];
        if (!is_beyond(v[j], modes->y_star[j])) continue;
        beyond_disc(v[j], modes->y_star[j], beyond, slope);
        for (int i = 0; i < count; i++)
            for (int d = 0; d < 2 && i != j; d++)
                wanted[i][d] -= compliance(&modes->beam, i, j) / compliance(&modes->beam, j, j) * beyond[d];
    }
    for (int i = 0; i < count; i++)
        for (int d = 0; d < 2; d++) off = larger(off, fabs(wanted[i][d] - v[i][d]));
    return off;
}

/* Bring one stabilizer after the other to where it ought to be for the others: each time F gets nearer to its minimum. */
static inline void sweep(const Modes *modes, double q[MAX_STABILIZERS][2], double v[MAX_STABILIZERS][2], int sweeps) {
    double wanted[MAX_STABILIZERS][2];
    for (int k = 0; k < sweeps; k++)
        for (int i = 0; i < modes->beam.n - 1; i++) {
            off_balance(modes, q, v, wanted);
            memcpy(v[i], wanted[i], sizeof wanted[i]);
        }
}

/* The contacts that hold under q̃, with their v: semismooth Newton from the guess in `v`; where a correction does not bring
   it nearer, sweeps do, which always end at the solution. */
static inline Contact settle_discs(
    const Modes *modes, double q[MAX_STABILIZERS][2], double v[MAX_STABILIZERS][2], Contact contact
) {
    int count = modes->beam.n - 1;
    double wanted[MAX_STABILIZERS][2], scale = 0.0;
    for (int i = 0; i < count; i++)
        scale = larger(scale, larger(modes->y_star[i], larger(fabs(q[i][0]), fabs(q[i][1]))));
    double off = off_balance(modes, q, v, wanted);
    for (int round = 0; round < MOST_ROUNDS && off > SAME_OFFSET * scale; round++) {
        Contact now = {{0}, 0, {0}};
        double tried[MAX_STABILIZERS][2], of_touching[MAX_STABILIZERS][2], q_C[MAX_STABILIZERS][2];
        double F[MAX_STABILIZERS][2];
        for (int i = 0; i < count; i++) now.of[i] = is_beyond(v[i], modes->y_star[i]) ? TOUCHES : 0;
        Touching of = touching_of(modes, now);
        for (int a = 0; a < of.touching; a++)
            for (int d = 0; d < 2; d++) of_touching[a][d] = v[of.C[a]][d], q_C[a][d] = q[of.C[a]][d];
        int solved = solve_contacts(&of, q_C, of_touching, F, NULL);
        memcpy(tried, q, sizeof tried);
        for (int a = 0; a < of.touching && solved; a++) {
            for (int i = 0; i < count; i++)
                for (int d = 0; d < 2; d++) tried[i][d] += compliance(&modes->beam, i, of.C[a]) * F[a][d];
        }
        for (int a = 0; a < of.touching && solved; a++) memcpy(tried[of.C[a]], of_touching[a], sizeof of_touching[a]);
        double next = solved ? off_balance(modes, q, tried, wanted) : INFINITY;
        if (next < off) off = next, memcpy(v, tried, sizeof tried);
        else if (off <= ROUNDING * scale) break;
        else {
            sweep(modes, q, v, SWEEPS);
            off = off_balance(modes, q, v, wanted);
        }
    }
    for (int k = 0; k < LAST_SWEEPS && off > ROUNDING * scale; k += SWEEPS) {
        sweep(modes, q, v, SWEEPS);
        off = off_balance(modes, q, v, wanted);
    }
    for (int i = 0; i < count; i++) contact.of[i] = is_beyond(v[i], modes->y_star[i]) ? TOUCHES : 0;
    return contact;
}

#endif
