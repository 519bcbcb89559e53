//! Chapter 9: vertex and index buffers, and the triangles that they make.
//!
//! The source of the data flow: a list of attribute records, one for each vertex, and a list that says which three of
//! them make a triangle.
//!
//! ```
//! use rasterbook::mesh::Mesh;
//!
//! // A square: four vertices, two triangles.
//! let square = Mesh::indexed(vec![[0, 0], [1, 0], [1, 1], [0, 1]], vec![0, 1, 2, 0, 2, 3])?;
//! assert_eq!(square.triangles().collect::<Vec<_>>(), [[0, 1, 2], [0, 2, 3]]);
//! # Ok::<(), rasterbook::mesh::MeshError>(())
//! ```

use std::fmt;

/// Vertices, and how they are put together to triangles.
///
/// `A` is the attribute record of a vertex: whatever the vertex shader needs, such as a position and texture
/// coordinates. The book keeps two buffers of numbers side by side (section 9.2, Figure 9-2); a list of records says
/// the same.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mesh<A> {
    vertices: Vec<A>,
    indices: Option<Vec<u32>>,
}

/// Why buffers do not make a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshError {
    /// Triangles need three vertices each.
    NotTriangles {
        /// How many vertices or indices there are.
        count: usize,
    },
    /// An index names a vertex that does not exist.
    IndexOutOfRange {
        /// The index.
        index: u32,
        /// How many vertices there are.
        vertices: usize,
    },
}

impl fmt::Display for MeshError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotTriangles { count } => write!(f, "{count} vertices do not make whole triangles"),
            Self::IndexOutOfRange { index, vertices } => {
                write!(f, "index {index}, but there are {vertices} vertices")
            }
        }
    }
}

impl std::error::Error for MeshError {}

impl<A> Mesh<A> {
    /// Triangles whose vertices stand one after the other: 0 1 2, 3 4 5, …
    ///
    /// # Errors
    /// If the number of vertices is not a multiple of three.
    pub fn unindexed(vertices: Vec<A>) -> Result<Self, MeshError> {
        if !vertices.len().is_multiple_of(3) {
            return Err(MeshError::NotTriangles { count: vertices.len() });
        }
        Ok(Self { vertices, indices: None })
    }

    /// Triangles that name their vertices, so that neighbors share them.
    ///
    /// # Errors
    /// If the number of indices is not a multiple of three, or one of them names no vertex.
    pub fn indexed(vertices: Vec<A>, indices: Vec<u32>) -> Result<Self, MeshError> {
        if !indices.len().is_multiple_of(3) {
            return Err(MeshError::NotTriangles { count: indices.len() });
        }
        if let Some(&index) = indices.iter().find(|&&index| index as usize >= vertices.len()) {
            return Err(MeshError::IndexOutOfRange { index, vertices: vertices.len() });
        }
        Ok(Self { vertices, indices: Some(indices) })
    }

    /// The attribute records.
    #[must_use]
    #[inline]
    pub fn vertices(&self) -> &[A] {
        &self.vertices
    }

    /// How many triangles there are.
    #[must_use]
    #[inline]
    pub fn triangle_count(&self) -> usize {
        self.indices.as_ref().map_or(self.vertices.len(), Vec::len) / 3
    }

    // ANCHOR: triangles
    /// Primitive assembly: the triangles in order, each as the positions of its three vertices in
    /// the list.
    pub fn triangles(&self) -> impl Iterator<Item = [usize; 3]> {
        (0..self.triangle_count()).map(|number| self.triangle(number))
    }

    /// One triangle, counted from 0: the positions of its vertices in the list.
    ///
    /// # Panics
    /// If there is no such triangle.
    #[must_use]
    #[inline]
    pub fn triangle(&self, number: usize) -> [usize; 3] {
        match &self.indices {
            None => {
                assert!(number < self.triangle_count(), "there is no triangle {number}");
                [0, 1, 2].map(|vertex| 3 * number + vertex)
            }
            Some(indices) => indices.as_chunks::<3>().0[number].map(|index| index as usize),
        }
    }
    // ANCHOR_END: triangles

    /// The same triangles with other records for their vertices.
    #[must_use]
    pub fn map<B>(&self, record: impl FnMut(&A) -> B) -> Mesh<B> {
        Mesh { vertices: self.vertices.iter().map(record).collect(), indices: self.indices.clone() }
    }

    /// The same triangles without shared vertices.
    #[must_use]
    pub fn to_unindexed(&self) -> Self
    where
        A: Clone,
    {
        let vertices = self.triangles().flatten().map(|index| self.vertices[index].clone()).collect();
        Self { vertices, indices: None }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unindexed_triangles_are_consecutive() {
        let mesh = Mesh::unindexed(vec!["a", "b", "c", "d", "e", "f"]).expect("two triangles");
        assert_eq!(mesh.triangles().collect::<Vec<_>>(), [[0, 1, 2], [3, 4, 5]]);
        assert_eq!(mesh.triangle_count(), 2);
    }

    #[test]
    fn bad_buffers_are_refused() {
        assert_eq!(Mesh::unindexed(vec![0; 4]).err(), Some(MeshError::NotTriangles { count: 4 }));
        assert_eq!(Mesh::indexed(vec![0; 4], vec![0, 1]).err(), Some(MeshError::NotTriangles { count: 2 }));
        let error = Mesh::indexed(vec![0; 4], vec![0, 1, 4]).err();
        assert_eq!(error, Some(MeshError::IndexOutOfRange { index: 4, vertices: 4 }));
        assert!(Mesh::<u8>::unindexed(vec![]).is_ok_and(|empty| empty.triangles().next().is_none()));
        let messages =
            [MeshError::NotTriangles { count: 4 }, MeshError::IndexOutOfRange { index: 4, vertices: 3 }]
                .map(|error| error.to_string());
        assert_eq!(messages, ["4 vertices do not make whole triangles", "index 4, but there are 3 vertices"]);
    }

    #[test]
    fn the_same_triangles_in_other_meshes() {
        let square = Mesh::indexed(vec!['a', 'b', 'c', 'd'], vec![0, 1, 2, 0, 2, 3]).expect("two triangles");
        let capitals = square.map(char::to_ascii_uppercase);
        assert_eq!(capitals.vertices(), ['A', 'B', 'C', 'D']);
        assert_eq!(capitals.triangles().collect::<Vec<_>>(), [[0, 1, 2], [0, 2, 3]], "vertices stay shared");
        let unshared = square.to_unindexed();
        assert_eq!(unshared.vertices(), ['a', 'b', 'c', 'a', 'c', 'd']);
        assert_eq!(unshared.triangle(1), [3, 4, 5]);
    }
}
