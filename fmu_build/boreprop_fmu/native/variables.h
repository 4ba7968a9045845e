/* The variables of the FMU: which there are follows from the table of quantities and the structure of the system. */
#ifndef BOREPROP_VARIABLES_H
#define BOREPROP_VARIABLES_H

#include "system.h"
#include <limits.h>

typedef enum { INPUT, OUTPUT, PARAMETER } Role;
typedef enum { REAL, INTEGER, BOOLEAN, STRING } Kind;
typedef struct {
    char name[48];
    Role role;
    Kind kind;
    int quantity, index; /* in the table of its role; of several of a kind */
} Variable;

enum { MOST_VARIABLES = INPUT_COUNT + MOST_OUTPUTS + MOST_PARAMETERS + 1 };

/* All variables by value reference: the inputs in the order of INPUT_TABLE, of which all have their number there up to the
   first that may be missing, the outputs, the parameters of the kernel, and last the survey file. */
typedef struct {
    Structure structure;
    int count;
    /* value references */
    int first_output, first_parameter, first_clearance, eta_pi, relative_tolerance, survey_file;
    int input[INPUT_COUNT]; /* by number in INPUT_TABLE, of those that there are */
    Variable at[MOST_VARIABLES];
} Variables;

/* Whether a number can be the value of a variable of this kind. */
static int is_value_of(Kind kind, double value) {
    return kind != INTEGER || (fabs(value) <= INT_MAX && value == floor(value));
}

static void add_variables(Variables *all, int place, Name quantity, Size size, Role role, Kind kind) {
    for (int i = 0; i < value_count(size, all->structure); i++) {
        Variable *next = &all->at[all->count++];
        if (!is_list(size)) snprintf(next->name, sizeof next->name, "%s", NAME[quantity]);
        else snprintf(next->name, sizeof next->name, "%s[%d]", NAME[quantity], i + 1);
        next->role = role, next->kind = kind, next->quantity = place, next->index = i;
    }
}

/* The variables of a drilling system of this structure. */
static void list_variables(Variables *all, Structure structure) {
    all->structure = structure, all->count = 0;
    for (int k = 0; k < INPUT_COUNT; k++) {
        all->input[k] = all->count;
        add_variables(
            all, k, INPUT_TABLE[k].name, INPUT_TABLE[k].size, INPUT, INPUT_TABLE[k].is_whole ? INTEGER : REAL
        );
    }
    all->first_output = all->count;
    for (int k = 0; k < OUTPUT_COUNT; k++) {
        if (k == OUT_ETA_PI) all->eta_pi = all->count;
        add_variables(all, k, OUTPUT_NAME[k], OUTPUT_SIZE[k], OUTPUT, OUTPUT_IS_WHOLE[k] ? INTEGER : REAL);
    }
    all->first_parameter = all->count;
    for (int k = 0; k < PARAMETER_COUNT; k++) {
        Kind kind = PARAMETER_TABLE[k].is_whole ? INTEGER : REAL;
        if (PARAMETER_TABLE[k].name == Q_RELATIVE_TOLERANCE) all->relative_tolerance = all->count;
        if (PARAMETER_TABLE[k].name == Q_STABILIZER_CLEARANCE) all->first_clearance = all->count;
        add_variables(all, k, PARAMETER_TABLE[k].name, PARAMETER_TABLE[k].size, PARAMETER, kind);
    }
    all->survey_file = all->count;
    add_variables(all, 0, Q_SURVEY_FILE, ONE, PARAMETER, STRING);
}

/* Whether a variable is a parameter that may change along a run. */
static int is_tunable(const Variable *variable) {
    return variable->role == PARAMETER && variable->kind == REAL &&
           PARAMETER_TABLE[variable->quantity].name == Q_STABILIZER_CLEARANCE;
}

#endif
