/* Solves one of the stiff reference problems with CVODE of SUNDIALS: BDF, or Adams for Pleiades, with the analytic Jacobian in the
   stiff problems. Usage: stiff PROBLEM RTOL ATOL ROUNDS; prints the best time of a solve in seconds, the steps, and the end state. */
#include <cvode/cvode.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>
#include <time.h>

#define Y(i) NV_Ith_S(y, i)
#define F(i) NV_Ith_S(f, i)

static int vdpol(realtype t, N_Vector y, N_Vector f, void *d) {
  F(0) = Y(1);
  F(1) = 1000.0 * (1 - Y(0) * Y(0)) * Y(1) - Y(0);
  return 0;
}
static int vdpol_jac(realtype t, N_Vector y, N_Vector f, SUNMatrix J, void *d, N_Vector a, N_Vector b, N_Vector c) {
  SM_ELEMENT_D(J, 0, 0) = 0;
  SM_ELEMENT_D(J, 0, 1) = 1;
  SM_ELEMENT_D(J, 1, 0) = -2000.0 * Y(0) * Y(1) - 1;
  SM_ELEMENT_D(J, 1, 1) = 1000.0 * (1 - Y(0) * Y(0));
  return 0;
}
static int rober(realtype t, N_Vector y, N_Vector f, void *d) {
  F(0) = -0.04 * Y(0) + 1e4 * Y(1) * Y(2);
  F(2) = 3e7 * Y(1) * Y(1);
  F(1) = -F(0) - F(2);
  return 0;
}
static int rober_jac(realtype t, N_Vector y, N_Vector f, SUNMatrix J, void *d, N_Vector a, N_Vector b, N_Vector c) {
  SM_ELEMENT_D(J, 0, 0) = -0.04;
  SM_ELEMENT_D(J, 0, 1) = 1e4 * Y(2);
  SM_ELEMENT_D(J, 0, 2) = 1e4 * Y(1);
  SM_ELEMENT_D(J, 2, 0) = 0;
  SM_ELEMENT_D(J, 2, 1) = 6e7 * Y(1);
  SM_ELEMENT_D(J, 2, 2) = 0;
  for (int j = 0; j < 3; j++) SM_ELEMENT_D(J, 1, j) = -SM_ELEMENT_D(J, 0, j) - SM_ELEMENT_D(J, 2, j);
  return 0;
}
static int pleiades(realtype t, N_Vector y, N_Vector f, void *d) {
  for (int i = 0; i < 14; i++) F(i) = Y(14 + i);
  for (int i = 0; i < 7; i++) {
    double fx = 0, fz = 0;
    for (int j = 0; j < 7; j++) {
      if (j == i) continue;
      double dx = Y(j) - Y(i), dz = Y(7 + j) - Y(7 + i), r2 = dx * dx + dz * dz, w = (j + 1) / (r2 * sqrt(r2));
      fx += w * dx;
      fz += w * dz;
    }
    F(14 + i) = fx;
    F(21 + i) = fz;
  }
  return 0;
}

int main(int argc, char **argv) {
  static const double start_vdpol[] = {2, 0}, start_rober[] = {1, 0, 0};
  static const double start_pleiades[] = {3, 3, -1, -3, 2, -2, 2, 3, -3, 2, 0, 0, -4, 4,
                                          0, 0, 0, 0, 0, 1.75, -1.5, 0, 0, 0, -1.25, 1, 0, 0};
  if (argc < 5) return 2;
  int stiff = strcmp(argv[1], "pleiades") != 0, n = stiff ? (argv[1][0] == 'v' ? 2 : 3) : 28;
  const double *start = n == 2 ? start_vdpol : n == 3 ? start_rober : start_pleiades;
  double end = n == 2 ? 2000 : n == 3 ? 1e11 : 3, rtol = atof(argv[2]), atol = atof(argv[3]), best = INFINITY;
  CVRhsFn rhs = n == 2 ? vdpol : n == 3 ? rober : pleiades;
  SUNContext context;
  SUNContext_Create(NULL, &context);
  N_Vector y = N_VNew_Serial(n, context);
  long steps = 0;
  for (int round = 0; round < atoi(argv[4]); round++) {
    struct timespec before, after;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &before);
    for (int i = 0; i < n; i++) Y(i) = start[i];
    void *cvode = CVodeCreate(stiff ? CV_BDF : CV_ADAMS, context);
    CVodeInit(cvode, rhs, 0, y);
    CVodeSStolerances(cvode, rtol, atol);
    CVodeSetMaxNumSteps(cvode, 10000000);
    SUNMatrix matrix = stiff ? SUNDenseMatrix(n, n, context) : NULL;
    SUNLinearSolver solver = stiff ? SUNLinSol_Dense(y, matrix, context) : NULL;
    SUNNonlinearSolver fixed = stiff ? NULL : SUNNonlinSol_FixedPoint(y, 0, context);
    if (stiff) {
      CVodeSetLinearSolver(cvode, solver, matrix);
      CVodeSetJacFn(cvode, n == 2 ? vdpol_jac : rober_jac);
    } else {
      CVodeSetNonlinearSolver(cvode, fixed);
    }
    CVodeSetStopTime(cvode, end);
    realtype t;
    if (CVode(cvode, end, y, &t, CV_NORMAL) < 0) return 1;
    CVodeGetNumSteps(cvode, &steps);
    CVodeFree(&cvode);
    if (stiff) SUNLinSolFree(solver), SUNMatDestroy(matrix);
    if (!stiff) SUNNonlinSolFree(fixed);
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &after);
    double took = after.tv_sec - before.tv_sec + 1e-9 * (after.tv_nsec - before.tv_nsec);
    if (took < best) best = took;
  }
  printf("%.9e %ld", best, steps);
  for (int i = 0; i < n; i++) printf(" %.17e", Y(i));
  printf("\n");
  return 0;
}
