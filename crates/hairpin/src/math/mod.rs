//! Floor 1: numbers without robots or time stamps.

pub mod random;
