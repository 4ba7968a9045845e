/* A C host that times an FMI 2.0 co-simulation FMU: prints what one call costs, in ns, one figure a line.

   native_host LIBRARY GUID RESOURCES FORCE OUTPUT LENGTH

   FORCE, OUTPUT and LENGTH are the value references of the force, of the output that is read, and of the drilled
   length. Needs the FMI 2.0 headers. */
#define _POSIX_C_SOURCE 200809L
#include <dlfcn.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "fmi2Functions.h"

#define STEP 3.66e-3   /* s, at 1 m/s a thousandth of ℓ₁ */
#define FORCE_STEP 1e3 /* N, from one step to the next where the force changes */

enum { REPETITIONS = 7, STARTS = 200, STEPS = 100000 };

static fmi2InstantiateTYPE *Instantiate;
static fmi2SetupExperimentTYPE *SetupExperiment;
static fmi2EnterInitializationModeTYPE *EnterInitializationMode;
static fmi2ExitInitializationModeTYPE *ExitInitializationMode;
static fmi2DoStepTYPE *DoStep;
static fmi2GetRealTYPE *GetReal;
static fmi2SetRealTYPE *SetReal;
static fmi2FreeInstanceTYPE *FreeInstance;

static const char *guid, *resources;
static fmi2ValueReference force, output, length;

static void print_message(
    fmi2ComponentEnvironment environment, fmi2String instance, fmi2Status status, fmi2String category,
    fmi2String message, ...
) {
    va_list arguments;
    (void)environment, (void)instance, (void)status, (void)category;
    va_start(arguments, message);
    vfprintf(stderr, message, arguments);
    va_end(arguments);
    fputc('\n', stderr);
}

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return 1e9 * (double)t.tv_sec + (double)t.tv_nsec;
}

static void expect(int right, const char *what) {
    if (!right) {
        fprintf(stderr, "%s failed\n", what);
        exit(3);
    }
}

static fmi2Component start(void) {
    static const fmi2CallbackFunctions callbacks = {print_message, calloc, free, NULL, NULL};
    fmi2Component component = Instantiate("host", fmi2CoSimulation, guid, resources, &callbacks, fmi2False, fmi2True);
    expect(component != NULL, "fmi2Instantiate");
    expect(SetupExperiment(component, fmi2False, 0.0, 0.0, fmi2False, 0.0) == fmi2OK, "fmi2SetupExperiment");
    expect(EnterInitializationMode(component) == fmi2OK, "fmi2EnterInitializationMode");
    expect(ExitInitializationMode(component) == fmi2OK, "fmi2ExitInitializationMode");
    return component;
}

/* ns a step, from a new start on. */
static double step(int set, int get) {
    fmi2Component component = start();
    double value, begin = now();
    for (int k = 0; k < STEPS; k++) {
        if (set) {
            value = FORCE_STEP * (k % 7);
            expect(SetReal(component, &force, 1, &value) == fmi2OK, "fmi2SetReal");
        }
        expect(DoStep(component, k * STEP, STEP, fmi2True) == fmi2OK, "fmi2DoStep");
        if (get) expect(GetReal(component, &output, 1, &value) == fmi2OK, "fmi2GetReal");
    }
    double mean = (now() - begin) / (double)STEPS;
    expect(GetReal(component, &length, 1, &value) == fmi2OK, "fmi2GetReal");
    expect(fabs(value - (double)STEPS * STEP) < 1e-6, "drilling as far as the steps go");
    FreeInstance(component);
    return mean;
}

/* ns to instantiate and initialize. */
static double starts(void) {
    double sum = 0.0;
    for (int k = 0; k < STARTS; k++) {
        double begin = now();
        fmi2Component component = start();
        sum += now() - begin;
        FreeInstance(component);
    }
    return sum / (double)STARTS;
}

static int compare(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void print_median(const char *name, double numbers[REPETITIONS]) {
    qsort(numbers, REPETITIONS, sizeof *numbers, compare);
    printf("%s %.1f\n", name, numbers[REPETITIONS / 2]);
}

int main(int count, char **arguments) {
    expect(count == 7, "native_host LIBRARY GUID RESOURCES FORCE OUTPUT LENGTH: starting");
    guid = arguments[2];
    resources = arguments[3];
    force = (fmi2ValueReference)atoi(arguments[4]);
    output = (fmi2ValueReference)atoi(arguments[5]);
    length = (fmi2ValueReference)atoi(arguments[6]);

    double begin = now();
    void *library = dlopen(arguments[1], RTLD_NOW);
    expect(library != NULL, "dlopen");
    *(void **)&Instantiate = dlsym(library, "fmi2Instantiate");
    *(void **)&SetupExperiment = dlsym(library, "fmi2SetupExperiment");
    *(void **)&EnterInitializationMode = dlsym(library, "fmi2EnterInitializationMode");
    *(void **)&ExitInitializationMode = dlsym(library, "fmi2ExitInitializationMode");
    *(void **)&DoStep = dlsym(library, "fmi2DoStep");
    *(void **)&GetReal = dlsym(library, "fmi2GetReal");
    *(void **)&SetReal = dlsym(library, "fmi2SetReal");
    *(void **)&FreeInstance = dlsym(library, "fmi2FreeInstance");
    FreeInstance(start());
    printf("first %.1f\n", now() - begin);

    double again[REPETITIONS], held[REPETITIONS], read[REPETITIONS], changing[REPETITIONS], both[REPETITIONS];
    for (int k = 0; k < REPETITIONS; k++) {
        again[k] = starts();
        held[k] = step(0, 0);
        read[k] = step(0, 1);
        changing[k] = step(1, 0);
        both[k] = step(1, 1);
    }
    print_median("again", again);
    print_median("held", held);
    print_median("read", read);
    print_median("changing", changing);
    print_median("both", both);
    return 0;
}
