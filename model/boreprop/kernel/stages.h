/* Linear equations for the changes of the state at all nodes of a step in space: a block of 4 by 4 numbers for each pair of
   nodes. They are eliminated block by block. There is no search for pivots, since none is needed: each leading part of the
   derivative at the nodes has its eigenvalues on the right, so that the blocks on the diagonal are regular for a law that
   does not grow by orders of magnitude within a step. */
#ifndef BOREPROP_STAGES_H
#define BOREPROP_STAGES_H

#include "numbers.h"
#include "radau_tables.h"

typedef double Block[4][4];

typedef struct {
    Block block[S][S]; /* eliminated: on the diagonal inverses, below it what to take of each block above */
} Stages;

/* Invert, by the minors of the upper and the lower half; what is singular becomes infinite. */
static inline void invert(Block m) {
    static const int others[4][3] = {{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}};
    double minor[2][4][4], adjugate[4][4], determinant = 0.0;
    for (int half = 0; half < 2; half++)
        for (int i = 0; i < 4; i++)
            for (int j = i + 1; j < 4; j++)
                minor[half][i][j] = m[2 * half][i] * m[2 * half + 1][j] - m[2 * half + 1][i] * m[2 * half][j];
    for (int i = 0; i < 4; i++) {
        const int *o = others[i];
        for (int j = 0; j < 4; j++) {
            const double *row = m[j ^ 1]; /* the other one of its half */
            double (*of)[4] = minor[j < 2];
            double size = row[o[0]] * of[o[1]][o[2]] - row[o[1]] * of[o[0]][o[2]] + row[o[2]] * of[o[0]][o[1]];
            adjugate[i][j] = (i + j) % 2 ? -size : size;
        }
        determinant += m[0][i] * adjugate[i][0];
    }
    double share = 1 / determinant;
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++) m[i][j] = share * adjugate[i][j];
}

/* a becomes a times b. */
static inline void multiply(Block a, const Block b) {
    for (int i = 0; i < 4; i++) {
        double row[4] = {0.0};
        for (int k = 0; k < 4; k++)
            for (int j = 0; j < 4; j++) row[j] += a[i][k] * b[k][j];
        memcpy(a[i], row, sizeof row);
    }
}

/* Take a times b off. */
static inline void take_product(Block from, const Block a, const Block b) {
    for (int i = 0; i < 4; i++) {
        double row[4];
        memcpy(row, from[i], sizeof row);
        for (int k = 0; k < 4; k++)
            for (int j = 0; j < 4; j++) row[j] -= a[i][k] * b[k][j];
        memcpy(from[i], row, sizeof row);
    }
}

static inline void eliminate(Stages *stages) {
    Block(*block)[S] = stages->block;
    for (int s = 0; s < S; s++) {
        invert(block[s][s]);
        for (int k = s + 1; k < S; k++) {
            multiply(block[k][s], block[s][s]);
            for (int j = s + 1; j < S; j++) take_product(block[k][j], block[k][s], block[s][j]);
        }
    }
}

/* Take a times x off. */
static inline void take_share(double from[4], const Block a, const double x[4]) {
    for (int i = 0; i < 4; i++) from[i] -= a[i][0] * x[0] + a[i][1] * x[1] + a[i][2] * x[2] + a[i][3] * x[3];
}

/* Solve what is eliminated: the right side becomes the solution. */
static inline void solve_stages(const Stages *of, double x[S][4]) {
    for (int k = 1; k < S; k++)
        for (int s = 0; s < k; s++) take_share(x[k], of->block[k][s], x[s]);
    for (int s = S - 1; s >= 0; s--) {
        double rest[4];
        for (int j = s + 1; j < S; j++) take_share(x[s], of->block[s][j], x[j]);
        for (int i = 0; i < 4; i++) rest[i] = -x[s][i], x[s][i] = 0.0;
        take_share(x[s], of->block[s][s], rest);
    }
}

#endif
