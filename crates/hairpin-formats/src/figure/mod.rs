//! Tables and figures of experiments: numbers in, CSV and SVG out.

mod axis;
mod draw;
mod marks;
mod table;

pub use marks::{Axis, Figure, Marks, Point, Scale, Series, Spread};
pub use table::{Cell, Table};

impl Figure {
    /// The figure as SVG; the same figure gives the same bytes.
    ///
    /// # Errors
    /// What the drawing library says.
    pub fn svg(&self) -> Result<String, String> {
        draw::svg(self).map_err(|error| error.to_string())
    }
}

#[cfg(test)]
mod tests;
