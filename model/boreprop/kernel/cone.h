/* Contact in space: a support i whose offset δ_i from the axis of the hole lies within a disc |δ_i| <= y*_i, and which
   the wall pushes towards the axis. F minimises ½ Fᵀ(K⁻¹ ⊗ I)F + q̃·F + Σ y*_i |F_i|, so it is unique.

   With any k_i > 0 and v_i = δ_i − k_i F_i, the offset is the point of the disc that is nearest to v_i:

       in contact  δ_i = y*_i v_i/|v_i| ,   F_i = −(v_i − δ_i)/k_i ,   |v_i| >= y*_i ;        free  δ_i = v_i ,   F_i = 0

   and v_i = q̃_i + Σ_j (K⁻¹_ij − k_i [i = j]) F_j . Within a regime this is smooth, and solved by Newton's method. k_i is what
   support i yields to a force while the others that touch stay: so v is of the size of y* beside the wall. */
#ifndef BOREPROP_CONE_H
#define BOREPROP_CONE_H

#include "interior.h"

enum { TOUCHES = -1 }; /* the contact beyond the bound of a free offset, as `change` has it */

/* The direction of a vector whose length is known to be at least `least` while its regime holds: a function w of the
   square of the length. It is one over the length from REACHED of that on. Below, where a trial step goes too far, it stays
   nearly the same, so that what it gives is nearly that of the regime beyond. Gives w, and twice its derivative. */
#define REACHED 0.99
static inline void direction_factors(double square, double least, double *w, double *bend) {
    double inner = REACHED * least, from = inner * inner;
    if (square >= from) {
        *w = 1 / sqrt(square), *bend = -*w * *w * *w;
        return;
    }
    double t = 1 - square / from; /* the first terms of (1 − t)^(−1/2), and one that brings it back to 1 */
    *w = (1 + t * (1.0 / 2 + t * (3.0 / 8 - t * (7.0 / 8)))) / inner;
    *bend = -2 * (1.0 / 2 + t * (3.0 / 4 - t * (21.0 / 8))) / (inner * from);
}

/* Whether v lies beyond the disc, so that the support touches; without clearance it always does. */
static inline int is_beyond(const double v[2], double y) { return y == 0.0 || length_of(v) > y; }

/* What the wall takes of v: v less the nearest point of the disc of radius y, and its derivative by v, row by row. */
static inline void beyond_disc(const double v[2], double y, double beyond[2], double slope[2][2]) {
    double w = 0.0, bend = 0.0;
    if (y > 0) direction_factors(v[0] * v[0] + v[1] * v[1], y, &w, &bend);
    for (int d = 0; d < 2; d++) {
        beyond[d] = v[d] - y * w * v[d];
        for (int c = 0; c < 2; c++) slope[d][c] = (d == c) * (1 - y * w) - y * bend * v[d] * v[c];
    }
}

/* A system of up to MOST_TOUCHING equations, row by row, with right sides behind each row. */
typedef double Equations[MOST_TOUCHING][MOST_TOUCHING + COMPONENTS];

/* Solve it: the right sides become the solutions. Returns 0 if it is singular. */
static inline int solve_equations(int size, int sides, Equations row) {
    for (int column = 0; column < size; column++) {
        int pivot = column;
        for (int i = column + 1; i < size; i++)
            if (fabs(row[i][column]) > fabs(row[pivot][column])) pivot = i;
        if (!(fabs(row[pivot][column]) > 0)) return 0;
        for (int j = column; pivot != column && j < size + sides; j++) {
            double value = row[pivot][j];
            row[pivot][j] = row[column][j], row[column][j] = value;
        }
        for (int i = column + 1; i < size; i++) {
            double factor = row[i][column] / row[column][column];
            if (factor == 0.0) continue;
            for (int j = column + 1; j < size + sides; j++) row[i][j] -= factor * row[column][j];
        }
    }
    for (int i = size - 1; i >= 0; i--)
        for (int side = size; side < size + sides; side++) {
            for (int j = i + 1; j < size; j++) row[i][side] -= row[i][j] * row[j][side];
            row[i][side] /= row[i][i];
        }
    return 1;
}

#define SAME_OFFSET 1e-14 /* relative: so near to the solution no correction brings v nearer */
enum { MOST_CORRECTIONS = 8 };
/* Over the largest v: after a change as small as this the next would be below rounding. Stabilizers close together enlarge
   the rounding of v, but not that of the equations, over their largest terms. */
#define NEXT_IS_NOTHING 1e-8
#define BALANCED 2e-15

/* What the wall takes of each v, and its derivative. */
typedef struct {
    double beyond[MAX_PLACES][2], slope[MAX_PLACES][2][2];
} Walls;

static inline void find_walls(const Touching *of, double v[MAX_PLACES][2], Walls *walls) {
    for (int a = 0; a < of->touching; a++) beyond_disc(v[a], of->y[a], walls->beyond[a], walls->slope[a]);
}

/* The same where walls do not pull. */
static inline void push_only(const Touching *of, double v[MAX_PLACES][2], Walls *walls) {
    for (int a = 0; a < of->touching; a++) {
        if (is_beyond(v[a], of->y[a])) continue;
        memset(walls->beyond[a], 0, sizeof walls->beyond[a]), memset(walls->slope[a], 0, sizeof walls->slope[a]);
    }
}

/* By how much v of one support changes with what the wall takes of another's, or its own. */
static inline double taken(const Touching *of, int a, int b) {
    return (a == b ? of->K_inv[a][a] - of->k[a] : of->K_inv[a][b]) / of->k[b];
}

/* The rows of the derivative of v − q̃ − Σ (K⁻¹ − k) F. */
static inline void fill_rows(const Touching *of, const Walls *walls, Equations matrix) {
    for (int a = 0; a < of->touching; a++)
        for (int b = 0; b < of->touching; b++) {
            double share = taken(of, a, b);
            for (int d = 0; d < 2; d++)
                for (int c = 0; c < 2; c++)
                    matrix[2 * a + d][2 * b + c] = (a == b && d == c) + share * walls->slope[b][d][c];
        }
}

/* Newton's method from the guess in `v`; returns 0 if it finds nothing. */
static inline int correct_contacts(const Touching *of, double q[MAX_PLACES][2], double v[MAX_PLACES][2], Walls *walls) {
    Equations matrix;
    int m = of->touching, size = 2 * m, found = 0;
    for (int correction = 0; correction < MOST_CORRECTIONS && !found; correction++) {
        double change = 0.0, scale = 0.0;
        int balanced = 1;
        fill_rows(of, walls, matrix);
        for (int a = 0; a < m; a++)
            for (int d = 0; d < 2; d++) {
                double *rest = &matrix[2 * a + d][size], terms = fabs(q[a][d]) + fabs(v[a][d]);
                *rest = q[a][d] - v[a][d];
                for (int b = 0; b < m; b++) {
                    double term = taken(of, a, b) * walls->beyond[b][d];
                    *rest -= term, terms += fabs(term);
                }
                balanced &= fabs(*rest) <= BALANCED * terms;
            }
        if (!solve_equations(size, 1, matrix)) return 0;
        for (int a = 0; a < m; a++)
            for (int d = 0; d < 2; d++) {
                double by = matrix[2 * a + d][size];
                v[a][d] += by;
                change = larger(change, fabs(by)), scale = larger(scale, larger(fabs(v[a][d]), of->y[a]));
            }
        if (!isfinite(change)) return 0;
        found = change <= NEXT_IS_NOTHING * scale || balanced;
        find_walls(of, v, walls);
    }
    return found;
}

/* The v of those that touch under their q̃, sought from a guess in `v`. Where a wall would have to pull so much that there is
   none, it is that of the contact problem, in which those that do not reach the wall are free. Where `by` is given,
   derivatives of q̃ by the state, row by row over the directions of each, it becomes those of F; returns 0 if there are none. */
static inline int solve_contacts(
    const Touching *of, double q[MAX_PLACES][2], double v[MAX_PLACES][2], double F[MAX_PLACES][2],
    double by[MOST_TOUCHING][COMPONENTS]
) {
    int m = of->touching, size = 2 * m;
    Equations matrix;
    Walls walls;
    if (m == 1) v[0][0] = q[0][0], v[0][1] = q[0][1];
    find_walls(of, v, &walls);
    if (m > 1 && !correct_contacts(of, q, v, &walls)) {
        double near[MAX_PLACES][2];
        approach(of, q, near);
        memcpy(v, near, (size_t)m * sizeof near[0]);
        find_walls(of, v, &walls);
        if (!correct_contacts(of, q, v, &walls)) {
            memcpy(v, near, (size_t)m * sizeof near[0]);
            find_walls(of, v, &walls), push_only(of, v, &walls);
        }
    }
    for (int a = 0; a < m; a++)
        for (int d = 0; d < 2; d++) F[a][d] = -walls.beyond[a][d] / of->k[a];
    if (!by) return 1;
    if (m > 1) {
        fill_rows(of, &walls, matrix);
        for (int i = 0; i < size; i++) memcpy(&matrix[i][size], by[i], sizeof by[i]);
        if (!solve_equations(size, COMPONENTS, matrix)) return 0;
        for (int i = 0; i < size; i++) memcpy(by[i], &matrix[i][size], sizeof by[i]);
    }
    for (int a = 0; a < m; a++)
        for (int c = 0; c < COMPONENTS; c++) {
            double v_by[2] = {by[2 * a][c], by[2 * a + 1][c]};
            for (int d = 0; d < 2; d++) by[2 * a + d][c] = -dot(2, walls.slope[a][d], v_by) / of->k[a];
        }
    return 1;
}

/* v as it is with another k. */
static inline void restate(const double v[2], double y, double k, double other, double restated[2]) {
    double beyond[2] = {0.0, 0.0}, slope[2][2];
    if (is_beyond(v, y)) beyond_disc(v, y, beyond, slope);
    for (int d = 0; d < 2; d++) restated[d] = v[d] - (1 - other / k) * beyond[d];
}

/* How far v is from a solution over all supports, whose k are those on the diagonal of K⁻¹, at most. */
static inline double off_balance(const Touching *all, double q[MAX_PLACES][2], double v[MAX_PLACES][2]) {
    int count = all->touching;
    double off = 0.0, wanted[MAX_PLACES][2]; /* where each ought to be for the others */
    for (int i = 0; i < count; i++) memcpy(wanted[i], q[i], sizeof wanted[i]);
    for (int j = 0; j < count; j++) {
        double beyond[2], slope[2][2];
        if (!is_beyond(v[j], all->y[j])) continue;
        beyond_disc(v[j], all->y[j], beyond, slope);
        for (int i = 0; i < count; i++)
            for (int d = 0; d < 2 && i != j; d++) wanted[i][d] -= all->K_inv[i][j] / all->k[j] * beyond[d];
    }
    for (int i = 0; i < count; i++)
        for (int d = 0; d < 2; d++) off = larger(off, fabs(wanted[i][d] - v[i][d]));
    return off;
}

/* Those of all supports that lie beyond their discs, by their numbers among all. */
static inline Touching touching_among(const Touching *all, double v[MAX_PLACES][2]) {
    Touching of;
    int m = 0;
    for (int i = 0; i < all->touching; i++)
        if (is_beyond(v[i], all->y[i])) of.C[m] = i, of.y[m++] = all->y[i];
    of.touching = m;
    for (int a = 0; a < m; a++)
        for (int b = 0; b < m; b++) of.K_inv[a][b] = all->K_inv[of.C[a]][of.C[b]];
    find_yields(&of);
    return of;
}

/* One try to bring v to a solution: the forces of those that touch as it is, and where all supports are under them.
   Returns how far it then is from one; infinity if there are no such forces. */
static inline double try_contacts(
    const Touching *all, double q[MAX_PLACES][2], double v[MAX_PLACES][2], double tried[MAX_PLACES][2]
) {
    double own[MAX_PLACES][2], q_C[MAX_PLACES][2], F[MAX_PLACES][2];
    int count = all->touching;
    Touching of = touching_among(all, v);
    for (int a = 0; a < of.touching; a++) {
        restate(v[of.C[a]], of.y[a], of.K_inv[a][a], of.k[a], own[a]);
        memcpy(q_C[a], q[of.C[a]], sizeof q_C[a]);
    }
    if (!solve_contacts(&of, q_C, own, F, NULL)) return INFINITY;
    for (int i = 0; i < count; i++) memcpy(tried[i], q[i], sizeof tried[i]);
    for (int a = 0; a < of.touching; a++)
        for (int i = 0; i < count; i++)
            for (int d = 0; d < 2; d++) tried[i][d] += all->K_inv[i][of.C[a]] * F[a][d];
    for (int a = 0; a < of.touching; a++) restate(own[a], of.y[a], of.k[a], of.K_inv[a][a], tried[of.C[a]]);
    return off_balance(all, q, tried);
}

/* The largest number of some vectors. */
static inline double largest_of(int count, double v[MAX_PLACES][2]) {
    double largest = 0.0;
    for (int i = 0; i < count; i++) largest = larger(largest, larger(fabs(v[i][0]), fabs(v[i][1])));
    return largest;
}

enum { MOST_ROUNDS = 60 };

/* Go on from v with the contacts as they are there, again while that brings it nearer to a solution over all supports by half.
   Returns how near it is then, over the largest number. */
static inline double improve(const Touching *all, double q[MAX_PLACES][2], double v[MAX_PLACES][2]) {
    int count = all->touching;
    double tried[MAX_PLACES][2], scale = largest_of(count, q), off = off_balance(all, q, v), before = INFINITY;
    for (int i = 0; i < count; i++) scale = larger(scale, all->y[i]);
    for (int round = 0; round < MOST_ROUNDS && off > SAME_OFFSET * scale && off < before / 2; round++) {
        double next = try_contacts(all, q, v, tried);
        before = off;
        if (!(next < off)) break;
        off = next, memcpy(v, tried, (size_t)count * sizeof tried[0]);
    }
    return off / larger(scale, largest_of(count, v)); /* forces of neighbours may make v much larger */
}

/* Bring v to the solution over all supports, from a guess if that leads there. */
static inline void settle_all(const Touching *all, double q[MAX_PLACES][2], double v[MAX_PLACES][2]) {
    double near[MAX_PLACES][2], off = improve(all, q, v);
    if (off <= ROUNDING) return;
    approach(all, q, near);
    if (improve(all, q, near) < off) memcpy(v, near, (size_t)all->touching * sizeof near[0]);
}

/* Guess each v: under the forces of those that touch in `contact`. Where the body touches, its points are many and near each
   other, and nothing else is near the solution. */
static inline void guess_under(
    const Modes *modes, double q[MAX_PLACES][2], const Contact *contact, double v[MAX_PLACES][2]
) {
    double q_C[MAX_PLACES][2], v_C[MAX_PLACES][2], F[MAX_PLACES][2];
    int n = modes->beam.n;
    Touching held = touching_of(modes, contact);
    find_yields(&held);
    for (int a = 0; a < held.touching; a++)
        memcpy(q_C[a], q[held.C[a]], sizeof q_C[a]), memcpy(v_C[a], q_C[a], sizeof v_C[a]);
    if (!solve_contacts(&held, q_C, v_C, F, NULL)) return;
    for (int i = 0; i < place_count(*contact, n); i++)
        for (int a = 0; a < held.touching && i != n - 1; a++)
            for (int d = 0; d < 2; d++)
                v[i][d] += compliance(&modes->beam, support_at(contact, n, i), held.support[a]) * F[a][d];
    for (int a = 0; a < held.touching; a++) restate(v_C[a], held.y[a], held.k[a], held.K_inv[a][a], v[held.C[a]]);
}

/* The contacts that hold under q̃ among the supports that have places, with their v where k_i = K⁻¹_ii, sought from those in
   `contact`. */
static inline Contact settle_discs(
    const Modes *modes, double q[MAX_PLACES][2], double v[MAX_PLACES][2], Contact contact
) {
    int n = modes->beam.n;
    double q_all[MAX_PLACES][2], v_all[MAX_PLACES][2];
    memcpy(v, q, (size_t)place_count(contact, n) * sizeof v[0]);
    if (contact.watched) guess_under(modes, q, &contact, v);
    memset(contact.of, TOUCHES, (size_t)place_count(contact, n));
    contact.of[n - 1] = 0;
    Touching all = touching_of(modes, &contact);
    for (int a = 0; a < all.touching; a++)
        memcpy(q_all[a], q[all.C[a]], sizeof q_all[a]), memcpy(v_all[a], v[all.C[a]], sizeof v_all[a]);
    settle_all(&all, q_all, v_all);
    for (int a = 0; a < all.touching; a++) {
        memcpy(v[all.C[a]], v_all[a], sizeof v_all[a]);
        contact.of[all.C[a]] = is_beyond(v_all[a], all.y[a]) ? TOUCHES : 0;
    }
    return contact;
}

#endif
