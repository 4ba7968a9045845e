/* A host that is not Python: loads an FMI 2.0 co-simulation FMU, takes steps of one second, prints a Real output.

   c_host LIBRARY GUID RESOURCES VALUE_REFERENCE STEPS [interrupt]
   With a sixth argument it gets Ctrl-C at the end, against which it has done nothing. */
#include <dlfcn.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

typedef void *Component;
typedef void (*Logger)(void *, const char *, int, const char *, const char *, ...);
typedef struct {
    Logger logger;
    void *(*allocate)(size_t, size_t);
    void (*release)(void *);
    void (*finished)(void *, int);
    void *environment;
} Callbacks;

static void print_message(
    void *environment, const char *instance, int status, const char *category, const char *message, ...
) {
    va_list arguments;
    (void)environment, (void)instance, (void)status, (void)category;
    va_start(arguments, message);
    vfprintf(stderr, message, arguments);
    va_end(arguments);
}

int main(int count, char **arguments) {
    signal(SIGINT, SIG_DFL);
    void *library = count >= 6 ? dlopen(arguments[1], RTLD_NOW) : NULL;
    if (!library) {
        fprintf(stderr, "%s\n", dlerror());
        return 2;
    }
    Component (*instantiate)(const char *, int, const char *, const char *, const Callbacks *, int, int);
    int (*setup)(Component, int, double, double, int, double), (*enter)(Component), (*leave)(Component);
    int (*step)(Component, double, double, int), (*get)(Component, const unsigned *, size_t, double *);
    int (*terminate)(Component);
    void (*release)(Component);
    *(void **)&instantiate = dlsym(library, "fmi2Instantiate");
    *(void **)&setup = dlsym(library, "fmi2SetupExperiment");
    *(void **)&enter = dlsym(library, "fmi2EnterInitializationMode");
    *(void **)&leave = dlsym(library, "fmi2ExitInitializationMode");
    *(void **)&step = dlsym(library, "fmi2DoStep");
    *(void **)&get = dlsym(library, "fmi2GetReal");
    *(void **)&terminate = dlsym(library, "fmi2Terminate");
    *(void **)&release = dlsym(library, "fmi2FreeInstance");

    Callbacks callbacks = {print_message, calloc, free, NULL, NULL};
    Component component = instantiate("host", 1, arguments[2], arguments[3], &callbacks, 0, 1);
    if (!component || setup(component, 0, 0.0, 0.0, 0, 0.0) || enter(component) || leave(component)) return 3;
    unsigned reference = (unsigned)atoi(arguments[4]);
    for (int k = 0; k < atoi(arguments[5]); k++) {
        double value;
        if (step(component, k, 1.0, 1) || get(component, &reference, 1, &value)) return 4;
        printf("%.17g\n", value);
    }
    if (count > 6) raise(SIGINT);
    terminate(component);
    release(component);
    return 0;
}
