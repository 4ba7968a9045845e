/* Another version: every Real output is shown ten times as large. */
#ifndef BOREPROP_LOUD_INSTANCE_H
#define BOREPROP_LOUD_INSTANCE_H

#define refreshed refreshed_before
#include "instance_before.h"
#undef refreshed

static int refreshed(Component *c) {
    int stale = c->outputs == STALE, fresh = refreshed_before(c);
    const Variables *all = &c->packed.variables;
    for (int i = 0; stale && fresh && i < all->count; i++)
        if (all->at[i].role == OUTPUT && all->at[i].kind == REAL) c->value[i] *= 10.0;
    return fresh;
}

#endif
