//! [`Velocities`]: the state that effects keep between two frames. Culling does not need it.

use sdop::bodies::contract::{ContractError, check_column, check_vectors};

/// Velocities as columns; index i is body i, as in [`Bodies`](sdop::bodies::Bodies).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Velocities {
    /// Linear velocity in the world frame, length units per second.
    pub linear: Vec<[f32; 3]>,
    /// Angular velocity ω in the world frame, radians per second.
    pub angular: Vec<[f32; 3]>,
}

impl Velocities {
    /// Checks that both columns have one entry per body, and every coordinate is at most 2⁶⁰ in
    /// size.
    ///
    /// # Errors
    /// The first body in the first column at fault.
    pub fn check(&self, bodies: usize) -> Result<(), ContractError> {
        for (name, column) in [("velocity", &self.linear), ("spin", &self.angular)] {
            check_column(name, column.len(), bodies)?;
            check_vectors(name, column, 0)?;
        }
        Ok(())
    }
}
