//! What best-first searches stand on: partial trajectories that share their beginnings, and a queue with two ends.

mod heap;
mod tree;

pub(super) use heap::IntervalHeap;
pub(super) use tree::Tree;
