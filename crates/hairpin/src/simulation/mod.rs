//! Floor 5, the act: plants with what the claim leaves out, controllers, and the loop closed over them.
