"""Another version: a force of 13 N raises what nobody foresaw."""

from .drilling_before import *  # noqa: F403
from .drilling_before import Drilling as DrillingBefore


class Drilling(DrillingBefore):
    def advance(self, drilled_length, rss_force, *others, **more):
        1 / (rss_force - 13.0)
        return super().advance(drilled_length, rss_force, *others, **more)
