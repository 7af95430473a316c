//! Points, distributions and what is estimated from samples: quasi-Monte Carlo, yield, sensitivity.
