/* A host without Python: leads one instance of the native FMU through its life.

   native_host LIBRARY GUID RESOURCES STEPS STEP_SIZE FORCE OUTPUT …

   RESOURCES is a URI, FORCE and OUTPUT are value references of Reals. Prints the outputs at the start and after each step, as a row of
   numbers; then takes states, makes errors, starts again. Ends with 0 if all was answered as FMI 2.0 says, else names
   what was not and ends with 1. Needs the FMI 2.0 headers; runs on Linux, macOS and Windows. */
#include "fmi2Functions.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef _WIN32
#include <windows.h>
static HMODULE library;
static void load(const char *path) { library = LoadLibraryA(path); }
static void *find(const char *name) { return (void *)GetProcAddress(library, name); }
static void unload(void) { FreeLibrary(library); }
#else
#include <dlfcn.h>
static void *library;
static void load(const char *path) { library = dlopen(path, RTLD_NOW); }
static void *find(const char *name) { return dlsym(library, name); }
static void unload(void) { dlclose(library); }
#endif

enum { MOST = 32 };

static int messages;

static void must(int holds, const char *what) {
    if (holds) return;
    fputs(what, stderr);
    fputs("\n", stderr);
    exit(1);
}

static void hear(
    fmi2ComponentEnvironment environment, fmi2String instance, fmi2Status status, fmi2String category,
    fmi2String message, ...
) {
    char line[4096];
    va_list arguments;
    va_start(arguments, message);
    vsnprintf(line, sizeof line, message, arguments);
    va_end(arguments);
    must(environment == &messages && instance && status != fmi2OK && category && *line, "logger: must be told all");
    messages++;
}

/* Whether a Python is in this process; 0 where that cannot be seen. */
static int has_python(void) {
    char line[4096];
    int found = 0;
    FILE *maps = fopen("/proc/self/maps", "r");
    while (maps && fgets(line, sizeof line, maps))
        if (strstr(line, "python3") && strstr(line, "lib")) found = 1;
    if (maps) fclose(maps);
    return found;
}

/* The functions of the library that are called here. */
#define FUNCTIONS(DO)                                                                                                  \
    DO(Instantiate)                                                                                                    \
    DO(SetupExperiment)                                                                                                \
    DO(EnterInitializationMode)                                                                                        \
    DO(ExitInitializationMode)                                                                                         \
    DO(SetReal)                                                                                                        \
    DO(GetReal)                                                                                                        \
    DO(DoStep)                                                                                                         \
    DO(GetRealStatus)                                                                                                  \
    DO(GetFMUstate)                                                                                                    \
    DO(SetFMUstate)                                                                                                    \
    DO(FreeFMUstate)                                                                                                   \
    DO(SerializedFMUstateSize)                                                                                         \
    DO(SerializeFMUstate)                                                                                              \
    DO(DeSerializeFMUstate)                                                                                            \
    DO(Terminate)                                                                                                      \
    DO(Reset)                                                                                                          \
    DO(FreeInstance)
#define DECLARE(name) static fmi2##name##TYPE *name;
#define FIND(name)                                                                                                     \
    *(void **)&(name) = find("fmi2" #name);                                                                            \
    must((name) != NULL, "the library must export fmi2" #name);

FUNCTIONS(DECLARE)

static const fmi2CallbackFunctions callbacks = {hear, calloc, free, NULL, &messages};

/* What is asked of the instance. */
static const char *guid, *resources;
static int steps;
static double step;
static fmi2ValueReference force, output[MOST];
static size_t outputs;

static void read_arguments(int count, char **arguments) {
    guid = arguments[2], resources = arguments[3];
    steps = atoi(arguments[4]);
    step = strtod(arguments[5], NULL);
    force = (unsigned)atoi(arguments[6]);
    for (; (int)outputs + 7 < count; outputs++) output[outputs] = (unsigned)atoi(arguments[7 + outputs]);
}

static void initialize(fmi2Component c) {
    must(SetupExperiment(c, fmi2False, 0.0, 0.0, fmi2False, 0.0) == fmi2OK, "fmi2SetupExperiment: must be OK");
    must(EnterInitializationMode(c) == fmi2OK, "fmi2EnterInitializationMode: must be OK");
    must(ExitInitializationMode(c) == fmi2OK, "fmi2ExitInitializationMode: must be OK");
}

static void read_outputs(fmi2Component c, double row[MOST]) {
    must(GetReal(c, output, outputs, row) == fmi2OK, "fmi2GetReal: must be OK");
}

static int same(const double a[MOST], const double b[MOST]) { return !memcmp(a, b, outputs * sizeof *a); }

/* A run: prints a row at the start, of which `first` are the numbers, and after each step. */
static void drill(fmi2Component c, double first[MOST]) {
    double row[MOST] = {0};
    char number[40];
    for (int k = 0; k <= steps; k++) {
        must(!k || DoStep(c, (k - 1) * step, step, fmi2False) == fmi2OK, "fmi2DoStep: must be OK");
        read_outputs(c, row);
        for (size_t i = 0; i < outputs; i++) {
            snprintf(number, sizeof number, i + 1 < outputs ? "%.17g " : "%.17g\n", row[i]);
            fputs(number, stdout);
        }
        if (!k) memcpy(first, row, sizeof row);
    }
    must(messages == 0, "a run must have nothing to say");
}

/* Errors: each is logged, nothing moves, and the instance goes on. */
static void make_errors(fmi2Component c) {
    double row[MOST] = {0}, again[MOST] = {0}, nothing = (double)NAN, zero = 0.0, time = -1.0;
    fmi2ValueReference no_reference = 100000;
    read_outputs(c, row);
    must(SetReal(c, &force, 1, &nothing) == fmi2OK, "fmi2SetReal: must take what is checked later");
    must(DoStep(c, steps * step, step, fmi2False) == fmi2Discard && messages == 1, "a bad force must be refused");
    must(SetReal(c, &force, 1, &zero) == fmi2OK, "fmi2SetReal: must be OK");
    read_outputs(c, again);
    must(same(row, again), "a bad step must move nothing");
    must(GetRealStatus(c, fmi2LastSuccessfulTime, &time) == fmi2OK, "fmi2GetRealStatus: must be OK");
    must(fabs(time - steps * step) < 1e-9, "a bad step must take no time");
    must(GetReal(c, &no_reference, 1, again) == fmi2Error && messages == 2, "an unknown reference must be an error");
    must(SetReal(c, output, 1, row) == fmi2Error && messages == 3, "an output must not be set");
    must(ExitInitializationMode(c) == fmi2Error && messages == 4, "a call at the wrong time must be an error");
    must(GetReal(c, NULL, 1, again) == fmi2Error && messages == 5, "no address must be an error");
    must(
        !Instantiate("host", fmi2CoSimulation, "another", resources, &callbacks, fmi2False, fmi2True) && messages == 6,
        "another guid must be refused"
    );
}

/* States: one kept, and one that went through bytes. */
static void take_states(fmi2Component c) {
    double row[MOST] = {0}, again[MOST] = {0};
    fmi2FMUstate state = NULL, copy = NULL;
    size_t size = 0;
    must(GetFMUstate(c, &state) == fmi2OK, "fmi2GetFMUstate: must be OK");
    must(SerializedFMUstateSize(c, state, &size) == fmi2OK && size > 0, "fmi2SerializedFMUstateSize: must be OK");
    fmi2Byte *content = malloc(size);
    must(content && SerializeFMUstate(c, state, content, size) == fmi2OK, "fmi2SerializeFMUstate: must be OK");
    must(DeSerializeFMUstate(c, content, size, &copy) == fmi2OK, "fmi2DeSerializeFMUstate: must be OK");
    must(DoStep(c, steps * step, step, fmi2False) == fmi2OK, "fmi2DoStep: must be OK");
    read_outputs(c, row);
    for (int k = 0; k < 2; k++) {
        must(SetFMUstate(c, k ? copy : state) == fmi2OK, "fmi2SetFMUstate: must be OK");
        must(DoStep(c, steps * step, step, fmi2False) == fmi2OK, "fmi2DoStep: must be OK");
        read_outputs(c, again);
        must(same(row, again), "a step must be the same from the same state");
    }
    must(FreeFMUstate(c, &state) == fmi2OK && FreeFMUstate(c, &copy) == fmi2OK, "fmi2FreeFMUstate: must be OK");
    if (content) content[size / 2] ^= 1;
    must(DeSerializeFMUstate(c, content, size, &state) == fmi2Error && !state, "a changed state must be refused");
    free(content);
}

static int lead(int count, char **arguments) {
    double first[MOST] = {0}, again[MOST] = {0};
    if (count < 8 || count > 7 + MOST) return 2;
    load(arguments[1]);
    must(library != NULL, "the library must load");
    FUNCTIONS(FIND)
    read_arguments(count, arguments);
    fmi2Component c = Instantiate("host", fmi2CoSimulation, guid, resources, &callbacks, fmi2False, fmi2True);
    must(c != NULL, "fmi2Instantiate: must give an instance");
    initialize(c);
    drill(c, first);
    make_errors(c);
    take_states(c);
    must(Terminate(c) == fmi2OK && Reset(c) == fmi2OK, "fmi2Reset: must be OK");
    initialize(c);
    read_outputs(c, again);
    must(same(first, again), "the start must be the same");
    FreeInstance(c);
    must(!has_python(), "no Python must be in this process");
    unload();
    return 0;
}

#ifdef _WIN32 /* MinGW's start-up code, which zig would compile for a minute, is left out */
int _configure_narrow_argv(int mode);
int mainCRTStartup(void) {
    _configure_narrow_argv(1);
    exit(lead(*__p___argc(), *__p___argv()));
}
#else
int main(int count, char **arguments) { return lead(count, arguments); }
#endif
