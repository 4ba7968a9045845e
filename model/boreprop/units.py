"""Units that people use."""

BUILD_LENGTH = 30.0  # m: build rates are told in degrees per 30 m
