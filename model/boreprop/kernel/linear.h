/* The little linear algebra that the kernel needs. */
#ifndef BOREPROP_LINEAR_H
#define BOREPROP_LINEAR_H

#include "numbers.h"

enum { SIZE = 64 }; /* of the largest matrix: that of all supports which may touch a wall at once */

/* Sum of the products of two lists. */
static inline double dot(int count, const double *a, const double *b) {
    double sum = 0.0;
    for (int i = 0; i < count; i++) sum += a[i] * b[i];
    return sum;
}

/* Inverse of a regular matrix by Gauss–Jordan elimination with pivoting. */
static inline void inverse(int size, const double matrix[SIZE][SIZE], double result[SIZE][SIZE]) {
    double rows[SIZE][2 * SIZE];
    for (int i = 0; i < size; i++)
        for (int j = 0; j < size; j++) rows[i][j] = matrix[i][j], rows[i][size + j] = i == j;
    for (int column = 0; column < size; column++) {
        int pivot = column;
        for (int i = column + 1; i < size; i++)
            if (fabs(rows[i][column]) > fabs(rows[pivot][column])) pivot = i;
        double divisor = rows[pivot][column];
        for (int j = 0; j < 2 * size; j++) {
            double value = rows[pivot][j];
            rows[pivot][j] = rows[column][j];
            rows[column][j] = value / divisor;
        }
        for (int i = 0; i < size; i++) {
            double factor = rows[i][column];
            if (i == column) continue;
            for (int j = 0; j < 2 * size; j++) rows[i][j] -= factor * rows[column][j];
        }
    }
    for (int i = 0; i < size; i++)
        for (int j = 0; j < size; j++) result[i][j] = rows[i][size + j];
}

/* A symmetric matrix, of which the upper half is there, or what is left of it when it has been eliminated. */
typedef struct {
    int size;
    double row[SIZE][SIZE];
} Symmetric;

/* Eliminate a positive matrix. By rounding it may be none where supports are close together. */
static inline void eliminate_symmetric(Symmetric *matrix) {
    double least[SIZE];
    for (int i = 0; i < matrix->size; i++) least[i] = 1e-16 * matrix->row[i][i];
    for (int column = 0; column < matrix->size; column++) {
        const double *top = matrix->row[column];
        matrix->row[column][column] = larger(top[column], least[column]);
        for (int i = column + 1; i < matrix->size; i++) {
            double factor = top[i] / top[column];
            for (int j = i; j < matrix->size; j++) matrix->row[i][j] -= factor * top[j];
        }
    }
}

/* Solve its equations: the right side becomes the solution. */
static inline void solve_symmetric(const Symmetric *eliminated, double x[SIZE]) {
    int size = eliminated->size;
    for (int column = 0; column < size; column++) {
        const double *top = eliminated->row[column];
        double factor = x[column] / top[column];
        for (int j = column + 1; j < size; j++) x[j] -= factor * top[j];
    }
    for (int i = size - 1; i >= 0; i--)
        x[i] = (x[i] - dot(size - 1 - i, &eliminated->row[i][i + 1], &x[i + 1])) / eliminated->row[i][i];
}

#endif
