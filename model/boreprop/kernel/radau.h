/* One step of Radau IIA collocation for x' = J x + g(t), with a constant 2×2 matrix J and x = (θ, Y).

   The solution over the step is the polynomial of degree S that meets the equation at the S right Radau nodes. Within a
   regime of the drilling system the equation is linear, so one linear solve gives it, with no Newton iteration. The
   eigenvalues of the collocation matrix split that solve into one 2×2 solve per eigenvalue (Hairer & Wanner, Solving
   Ordinary Differential Equations II, sections IV.5 and IV.8). */
#ifndef BOREPROP_RADAU_H
#define BOREPROP_RADAU_H

#include "numbers.h"
#include "radau_tables.h"

/* W holds one complex number for each eigenvalue, W_k = (γ_k − hJ)⁻¹ h f_k, where f_k is the share of the right-hand
   side in eigenvector k. A step of one component is the five parts of its W (real; real, imaginary; real, imaginary).
   The tables give its polynomial from these, and the parts of f from the values of f. */

typedef struct {
    double theta_theta, theta_Y, Y_theta, Y_Y;
} Jacobian;

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

/* The parts of f, given at the points. */
static inline void into_parts(const double f[POINTS], double parts[S]) {
    for (int m = 0; m < S; m++) parts[m] = INTO_PARTS[0][m] * f[0];
    for (int k = 1; k < POINTS; k++)
        if (k != AT_CHECK)
            for (int m = 0; m < S; m++) parts[m] += INTO_PARTS[k][m] * f[k];
}

/* Factor times (a x + b y), with a real or complex. */
static inline Complex solved(Complex factor, Complex a, Complex x, double b, Complex y) {
    Complex ax = times(a, x), sum = {ax.re + b * y.re, ax.im + b * y.im};
    return times(factor, sum);
}

/* One step of length `h` for θ and Y: the parts of their W.

   `f_theta` and `f_Y` are the right-hand sides at the points with (θ, Y) frozen at the start of the step. */
static inline void collocate(
    double h, Jacobian J, const double f_theta[POINTS], const double f_Y[POINTS], double theta[S], double Y[S]
) {
    double h11 = h * J.theta_theta, h12 = h * J.theta_Y, h21 = h * J.Y_theta, h22 = h * J.Y_Y;
    double f[S], g[S];
    into_parts(f_theta, f);
    into_parts(f_Y, g);
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

/* The component at the points. */
static inline void radau_values(double start, const double parts[S], double values[POINTS]) {
    for (int k = 0; k < POINTS; k++) values[k] = start;
    for (int m = 0; m < S; m++)
        for (int k = 0; k < POINTS; k++) values[k] += VALUES[m][k] * parts[m];
}

/* Coefficients of t^0 … t^S of the component. */
static inline void radau_coefficients(double start, const double parts[S], double c[S + 1]) {
    c[0] = start;
    for (int power = 0; power < S; power++) c[power + 1] = COEFFICIENTS[0][power] * parts[0];
    for (int m = 1; m < S; m++)
        for (int power = 0; power < S; power++) c[power + 1] += COEFFICIENTS[m][power] * parts[m];
}

/* Derivative of the component at the check, times h. */
static inline double radau_slope(const double p[S]) {
    return SLOPE[0] * p[0] + SLOPE[1] * p[1] + SLOPE[2] * p[2] + SLOPE[3] * p[3] + SLOPE[4] * p[4];
}

/* Errors of θ and Y from h times the defects at the check, slope less right-hand side.

   They are (1 − hJ/γ)⁻¹ times the defects, with the real eigenvalue γ, so that stiffness does not blow them up. */
static inline void radau_error(double h, Jacobian J, double defect_theta, double defect_Y, double *theta, double *Y) {
    double scale = h / GAMMA[0].re;
    double h11 = scale * J.theta_theta, h12 = scale * J.theta_Y, h21 = scale * J.Y_theta, h22 = scale * J.Y_Y;
    double determinant = (1 - h11) * (1 - h22) - h12 * h21;
    *theta = ((1 - h22) * defect_theta + h12 * defect_Y) / determinant;
    *Y = (h21 * defect_theta + (1 - h11) * defect_Y) / determinant;
}

#endif
