/* A host of the kernel's shared library, without Python and without its headers: drills one leg, and prints the outputs
   at its end, one a line.

   kernel_host LIBRARY LENGTH LIST LIST LIST LIST LIST LIST LIST

   A LIST is a count and as many numbers: the structure, the parameters, the options, the measured depths, the
   inclinations, the azimuths, and the inputs, as boreprop.h takes them. Runs on Linux, macOS and Windows; on Windows without start-up code, as native_host.c. */
#include <stdio.h>
#include <stdlib.h>

#ifdef _WIN32
#include <windows.h>
static HMODULE library;
static void load(const char *path) { library = LoadLibraryA(path); }
static void *find(const char *name) { return (void *)GetProcAddress(library, name); }
#else
#include <dlfcn.h>
static void *library;
static void load(const char *path) { library = dlopen(path, RTLD_NOW); }
static void *find(const char *name) { return dlsym(library, name); }
#endif

enum { MOST = 256 };
enum { STRUCTURE, PARAMETERS, OPTIONS, DEPTHS, INCLINATIONS, AZIMUTHS, INPUTS, LISTS };

static char **argument; /* the next one */

static void must(int holds, const char *what) {
    if (holds) return;
    fputs(what, stderr);
    fputs("\n", stderr);
    exit(1);
}

static double number(void) {
    must(*argument != NULL, "numbers: must not end here");
    return strtod(*argument++, NULL);
}

static int lead(char **arguments) {
    void *(*start)(
        const int *, const double *, const double *, long long, const double *, const double *, const double *, int,
        const double *, const double *, void *
    );
    long long (*follow)(
        void *, long long, const double *, const double *, const int *, const int *, double *, long long, long long,
        void *
    );
    int (*outputs)(void *, double *);
    void (*end)(void *);
    static double list[LISTS][MOST], out[MOST], problem[MOST];
    int count[LISTS], structure[MOST];
    must(arguments[1] != NULL, "the first argument must be a library");
    load(arguments[1]);
    must(library != NULL, "the library must load");
    *(void **)&start = find("boreprop_start"), *(void **)&follow = find("boreprop_follow");
    *(void **)&outputs = find("boreprop_outputs"), *(void **)&end = find("boreprop_end");
    must(start && follow && outputs && end, "the library must have the functions of boreprop.h");

    argument = arguments + 2;
    double length = number();
    for (int k = 0; k < LISTS; k++) {
        count[k] = (int)number();
        must(count[k] <= MOST, "lists: must not be longer");
        for (int i = 0; i < count[k]; i++) list[k][i] = number();
    }
    for (int i = 0; i < count[STRUCTURE]; i++) structure[i] = (int)list[STRUCTURE][i];
    void *run = start(
        structure, list[PARAMETERS], list[OPTIONS], count[DEPTHS], list[DEPTHS], list[INCLINATIONS], list[AZIMUTHS], 0,
        NULL, list[INPUTS], problem
    );
    must(run != NULL, "the run must start");
    const int first[] = {0}, no_row[] = {-1};
    long long drilled = follow(run, 1, &length, list[INPUTS], first, no_row, NULL, 0, 0, problem);
    must(drilled == 1, "the leg must be drilled");
    int n = outputs(run, out);
    for (int k = 0; k < n; k++) {
        char line[64];
        snprintf(line, sizeof line, "%.17g\n", out[k]);
        fputs(line, stdout);
    }
    end(run);
    return 0;
}

#ifdef _WIN32
int _configure_narrow_argv(int mode);
int mainCRTStartup(void) {
    _configure_narrow_argv(1);
    exit(lead(*__p___argv()));
}
#else
int main(int count, char **arguments) { return count > 1 ? lead(arguments) : 2; }
#endif
