/* The kernel in space: the same functions once more, for two lateral directions, under names of their own. */
#define SPACE
#define boreprop_sources_digest boreprop_space_sources_digest
#define boreprop_quantities_digest boreprop_space_quantities_digest
#define boreprop_sentence boreprop_space_sentence
#define boreprop_start boreprop_space_start
#define boreprop_end boreprop_space_end
#define boreprop_follow boreprop_space_follow
#define boreprop_step boreprop_space_step
#define boreprop_outputs boreprop_space_outputs
#define boreprop_length boreprop_space_length
#define boreprop_statistics boreprop_space_statistics
#define boreprop_state_size boreprop_space_state_size
#define boreprop_save boreprop_space_save
#define boreprop_change_clearances boreprop_space_change_clearances
#define boreprop_restore boreprop_space_restore
#include "library.c"
