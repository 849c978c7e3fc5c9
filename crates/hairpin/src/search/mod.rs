//! Floor 6: scores and the searches over them. Points, a leg test and a score come in as closures or traits.
