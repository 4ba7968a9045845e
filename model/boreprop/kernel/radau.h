/* One step of Radau IIA collocation for x' = J x + g(t), with a constant 2×2 matrix J and x = (θ, Y).

   The solution over the step is the polynomial of degree S that meets the equation at the S right Radau nodes. Within a
   mode of the drilling system the equation is linear, so one linear solve gives it, with no Newton iteration. The
   eigenvalues of the collocation matrix split that solve into one 2×2 solve per eigenvalue (Hairer & Wanner, Solving
   Ordinary Differential Equations II, sections IV.5 and IV.8). */
#ifndef BOREPROP_RADAU_H
#define BOREPROP_RADAU_H

#include "linear.h"

enum { S = 5, POINTS = S + 1, EIGENVALUES = 3, AT_CHECK = 3 };

typedef struct {
    double re, im;
} Complex;

/* The right Radau nodes on [0, 1], and CHECK between two of them, where the polynomial need not meet the equation. */
#define CHECK 0.72
static const double POINT[POINTS] = {0.057104196114517682193, 0.27684301363812382768, 0.58359043236891682006,
                                     CHECK,                   0.86024013565621944785, 1.0};
/* The eigenvalues of A⁻¹, A the collocation matrix (one of each conjugate pair): the poles of the (S−1, S) Padé
   approximant of the exponential. */
static const Complex GAMMA[EIGENVALUES] = {{6.2867047517292766452, 0.0},
                                           {5.7009532986717894192, 3.2102656003085498884},
                                           {3.6556943254635722582, 6.543736899360077294}};

static inline Complex times(Complex a, Complex b) {
    Complex product = {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
    return product;
}

static inline Complex quotient(Complex a, Complex b) {
    Complex result;
    if (fabs(b.re) >= fabs(b.im)) {
        double ratio = b.im / b.re, divisor = b.re + b.im * ratio;
        result.re = (a.re + a.im * ratio) / divisor, result.im = (a.im - a.re * ratio) / divisor;
    } else {
        double ratio = b.re / b.im, divisor = b.re * ratio + b.im;
        result.re = (a.re * ratio + a.im) / divisor, result.im = (a.im * ratio - a.re) / divisor;
    }
    return result;
}

/* W holds one complex number for each eigenvalue, W_k = (γ_k − hJ)⁻¹ h f_k, where f_k is the share of the right-hand
   side in eigenvector k. A step of one component is the five parts of its W (real; real, imaginary; real, imaginary);
   times a row of these tables they give: */
typedef struct {
    double values[POINTS][S];       /* the step's polynomial at the points, less its start */
    double coefficients[S][S];      /* and its coefficients of t … t^S */
    double slope[S];                /* and its derivative at the check; */
    double into_parts[SIZE][SIZE]; /* and this one the parts of f from its values at the nodes */
} Radau;

/* Coefficients, ascending, of R(t) = Π (t − t_j). */
static inline void node_polynomial(double r[S + 2]) {
    memset(r, 0, (S + 2) * sizeof *r);
    r[0] = 1.0;
    for (int k = 0; k < POINTS; k++)
        if (k != AT_CHECK) {
            for (int m = S; m > 0; m--) r[m] = r[m - 1] - POINT[k] * r[m];
            r[0] = 0.0 - POINT[k] * r[0];
        }
}

/* Coefficients of t … t^S of the polynomial v, v(0) = 0, with v' − γ v = R: v' = γ v at every node. */
static inline void eigenpolynomial(Complex gamma, const double r[S + 2], Complex v[S]) {
    Complex above = {0.0, 0.0};
    for (int m = S; m > 0; m--) {
        Complex rest = {(m + 1) * above.re - r[m], (m + 1) * above.im};
        above = v[m - 1] = quotient(rest, gamma);
    }
}

/* Factors of the parts of W in Re Σ_k values[k] W_k, the conjugate halves added. */
static inline void in_real_parts(const Complex values[EIGENVALUES], double parts[S]) {
    parts[0] = values[0].re;
    for (int k = 1; k < EIGENVALUES; k++) parts[2 * k - 1] = 2 * values[k].re, parts[2 * k] = -2 * values[k].im;
}

/* Value or derivative at `t` of the step's polynomial, as factors of the parts of W. */
static inline void polynomial_at(Complex v[EIGENVALUES][S], double t, int derivative, double parts[S]) {
    Complex values[EIGENVALUES];
    for (int k = 0; k < EIGENVALUES; k++) {
        Complex sum = {0.0, 0.0};
        for (int m = 0; m < S; m++) {
            double power = derivative ? (m + 1) * pow(t, m) : pow(t, m + 1);
            sum.re += v[k][m].re * power, sum.im += v[k][m].im * power;
        }
        values[k] = sum;
    }
    in_real_parts(values, parts);
}

static inline Radau make_radau(void) {
    Radau tables;
    double r[S + 2], at_nodes[SIZE][SIZE] = {{0}};
    Complex v[EIGENVALUES][S];
    node_polynomial(r);
    for (int k = 0; k < EIGENVALUES; k++) eigenpolynomial(GAMMA[k], r, v[k]);
    for (int k = 0; k < POINTS; k++) polynomial_at(v, POINT[k], 0, tables.values[k]);
    for (int m = 0; m < S; m++) {
        Complex of_power[EIGENVALUES] = {v[0][m], v[1][m], v[2][m]};
        in_real_parts(of_power, tables.coefficients[m]);
    }
    polynomial_at(v, CHECK, 1, tables.slope);
    for (int k = 0, node = 0; k < POINTS; k++)
        if (k != AT_CHECK) memcpy(at_nodes[node++], tables.values[k], sizeof tables.values[k]);
    memset(tables.into_parts, 0, sizeof tables.into_parts);
    inverse(S, (const double(*)[SIZE])at_nodes, tables.into_parts);
    return tables;
}

typedef struct {
    double theta_theta, theta_Y, Y_theta, Y_Y;
} Jacobian;

static inline void into_parts(const Radau *tables, const double f[POINTS], double parts[S]) {
    for (int k = 0; k < S; k++) {
        const double *row = tables->into_parts[k];
        parts[k] = row[0] * f[0] + row[1] * f[1] + row[2] * f[2] + row[3] * f[4] + row[4] * f[5];
    }
}

/* Factor times (a x + b y), with a real or complex. */
static inline Complex solved(Complex factor, Complex a, Complex x, double b, Complex y) {
    Complex ax = times(a, x), sum = {ax.re + b * y.re, ax.im + b * y.im};
    return times(factor, sum);
}

/* One step of length `h` for θ and Y: the parts of their W.

   `f_theta` and `f_Y` are the right-hand sides at the points with (θ, Y) held at the start of the step. */
static inline void collocate(
    const Radau *tables, double h, Jacobian J, const double f_theta[POINTS], const double f_Y[POINTS], double theta[S],
    double Y[S]
) {
    double h11 = h * J.theta_theta, h12 = h * J.theta_Y, h21 = h * J.Y_theta, h22 = h * J.Y_Y;
    double f[S], g[S];
    into_parts(tables, f_theta, f);
    into_parts(tables, f_Y, g);
    /* (γ − hJ) W = h (f, g), by Cramer's rule */
    double s11 = GAMMA[0].re - h11, s22 = GAMMA[0].re - h22, scale = h / (s11 * s22 - h12 * h21);
    theta[0] = scale * (s22 * f[0] + h12 * g[0]), Y[0] = scale * (h21 * f[0] + s11 * g[0]);
    for (int k = 1; k < EIGENVALUES; k++) {
        Complex z11 = {GAMMA[k].re - h11, GAMMA[k].im}, z22 = {GAMMA[k].re - h22, GAMMA[k].im};
        Complex f_k = {f[2 * k - 1], f[2 * k]}, g_k = {g[2 * k - 1], g[2 * k]}, length = {h, 0.0};
        Complex determinant = times(z11, z22);
        determinant.re -= h12 * h21;
        Complex factor = quotient(length, determinant);
        Complex theta_k = solved(factor, z22, f_k, h12, g_k), Y_k = solved(factor, z11, g_k, h21, f_k);
        theta[2 * k - 1] = theta_k.re, theta[2 * k] = theta_k.im;
        Y[2 * k - 1] = Y_k.re, Y[2 * k] = Y_k.im;
    }
}

static inline double of_parts(double start, const double row[S], const double p[S]) {
    return start + row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3] * p[3] + row[4] * p[4];
}

/* The component at the points. */
static inline void step_values(const Radau *tables, double start, const double parts[S], double values[POINTS]) {
    for (int k = 0; k < POINTS; k++) values[k] = of_parts(start, tables->values[k], parts);
}

/* Coefficients of t^0 … t^S of the component. */
static inline void step_coefficients(const Radau *tables, double start, const double parts[S], double c[S + 1]) {
    c[0] = start;
    for (int m = 0; m < S; m++) {
        const double *row = tables->coefficients[m];
        c[m + 1] = row[0] * parts[0] + row[1] * parts[1] + row[2] * parts[2] + row[3] * parts[3] + row[4] * parts[4];
    }
}

/* Derivative of the component at the check, times h. */
static inline double step_slope(const Radau *tables, const double p[S]) {
    const double *row = tables->slope;
    return row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3] * p[3] + row[4] * p[4];
}

/* Errors of θ and Y from h times the defects at the check, slope less right-hand side.

   (1 − hJ/γ)⁻¹ times the defects, γ the real eigenvalue: stiffness does not blow that up. */
static inline void step_error(double h, Jacobian J, double defect_theta, double defect_Y, double *theta, double *Y) {
    double scale = h / GAMMA[0].re;
    double h11 = scale * J.theta_theta, h12 = scale * J.theta_Y, h21 = scale * J.Y_theta, h22 = scale * J.Y_Y;
    double determinant = (1 - h11) * (1 - h22) - h12 * h21;
    *theta = ((1 - h22) * defect_theta + h12 * defect_Y) / determinant;
    *Y = (h21 * defect_theta + (1 - h11) * defect_Y) / determinant;
}

#endif
