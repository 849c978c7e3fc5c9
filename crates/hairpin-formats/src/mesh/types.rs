//! A mesh, and why bytes are none.

use thiserror::Error;

/// Vertices and triangles, m.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Mesh {
    /// Distinct points in the order of their first use.
    pub vertices: Vec<[f64; 3]>,
    /// Indices into `vertices`, from 0, in the file's orientation.
    pub triangles: Vec<[u32; 3]>,
}

/// Why bytes are no mesh.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum MeshError {
    /// The name says no format.
    #[error("must be named .stl, .obj or .dae")]
    Format,
    /// Shorter than the header of a binary STL file, and no ASCII one.
    #[error("is no STL file: {bytes} bytes are fewer than its header of 84")]
    NoHeader {
        /// Length of the file.
        bytes: usize,
    },
    /// An STL file ends before its triangles do.
    #[error("says {said} triangles, but holds {found}")]
    Truncated {
        /// Count in the header.
        said: u32,
        /// Whole triangles that follow.
        found: usize,
    },
    /// An STL file goes on behind its triangles.
    #[error("says {said} triangles, and {bytes} bytes more follow them")]
    Beyond {
        /// Count in the header.
        said: u32,
        /// What follows.
        bytes: usize,
    },
    /// A statement that may be a part of the world.
    #[error("line {line}: {word:?} is a statement of OBJ that is not read: vertices (v) and faces (f) are")]
    Statement {
        /// Number of the line, from 1.
        line: usize,
        /// Its first word.
        word: String,
    },
    /// A line that cannot be understood.
    #[error("line {line}: expected {expected}")]
    Line {
        /// Number of the line, from 1.
        line: usize,
        /// What should stand there.
        expected: &'static str,
    },
    /// A polygon that is no face.
    #[error("{place}: a face of {corners} corners {why}")]
    Face {
        /// Where in the file it is.
        place: String,
        /// How many corners it has.
        corners: usize,
        /// What is wrong.
        why: String,
    },
    /// Nothing that could be in the way.
    #[error("holds no triangles: {0}")]
    NoTriangles(String),
    /// No XML, or XML that is no Collada.
    #[error("is no Collada: {0}")]
    NoCollada(String),
    /// More triangles than are read.
    #[error("has more than {0} triangles")]
    TooMany(usize),
    /// A coordinate is NaN or infinite.
    #[error("vertex {vertex} is not finite")]
    NotFinite {
        /// Number of the vertex in the file, from 0.
        vertex: usize,
    },
}

/// Triangles of one file, at most: beyond, it is no link and no obstacle but a scan.
pub(super) const MOST_TRIANGLES: usize = 5_000_000;
