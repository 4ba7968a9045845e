/* The variables of the FMU: which there are follows from the table of quantities and the number of stabilizers. */
#ifndef BOREPROP_VARIABLES_H
#define BOREPROP_VARIABLES_H

#include "system.h"

typedef enum { INPUT, OUTPUT, PARAMETER } Role;
typedef enum { REAL, INTEGER, BOOLEAN, STRING } Kind;
typedef struct {
    char name[48];
    Role role;
    Kind kind;
} Variable;

enum { MOST_VARIABLES = INPUT_COUNT + MOST_OUTPUTS + MOST_PARAMETERS + 1 };

/* All variables by value reference: the inputs, numbered as in INPUT_TABLE, the outputs, the parameters of the kernel,
   and last the survey file. */
typedef struct {
    int n, count, first_output, first_parameter, survey_file; /* stabilizers, variables; value references */
    Variable at[MOST_VARIABLES];
} Variables;

static void add_variable(Variables *all, Name quantity, Size size, Role role, Kind kind) {
    for (int i = 0; i < value_count(size, all->n); i++) {
        Variable *next = &all->at[all->count++];
        if (size == ONE) snprintf(next->name, sizeof next->name, "%s", NAME[quantity]);
        else snprintf(next->name, sizeof next->name, "%s[%d]", NAME[quantity], i + 1);
        next->role = role, next->kind = kind;
    }
}

/* The variables for n stabilizers, 1 to MAX_STABILIZERS. */
static void list_variables(Variables *all, int n) {
    all->n = n, all->count = 0;
    for (int k = 0; k < INPUT_COUNT; k++) add_variable(all, INPUT_TABLE[k].name, INPUT_TABLE[k].size, INPUT, REAL);
    all->first_output = all->count;
    for (int k = 0; k < OUTPUT_COUNT; k++)
        add_variable(all, OUTPUT_NAME[k], OUTPUT_SIZE[k], OUTPUT, OUTPUT_IS_WHOLE[k] ? INTEGER : REAL);
    all->first_parameter = all->count;
    for (int k = 0; k < PARAMETER_COUNT; k++)
        add_variable(all, PARAMETER_TABLE[k].name, PARAMETER_TABLE[k].size, PARAMETER, REAL);
    all->survey_file = all->count;
    add_variable(all, Q_SURVEY_FILE, ONE, PARAMETER, STRING);
}

#endif
