//! Floor 6, the proof: equations and an integrator of its own, fed with what a campaign wrote.
