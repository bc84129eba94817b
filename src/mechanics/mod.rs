//! How forces move atoms: elasticity, loads, integration in time, constraints.
