//! Vertex attributes other than the position: normals, texture coordinates and colours.

/// The normals, texture coordinates or colours of a mesh: a list of values, and for each corner of
/// each triangle the index of its value.
///
/// In PLY and glTF these indices equal those of the positions; in OBJ they may differ. They are stored only if they
/// differ, because they take 12 bytes per triangle and attribute.
#[derive(Clone, Debug, PartialEq)]
pub struct Attribute<T> {
    values: Vec<T>,
    corners: CornerIndices,
}

#[derive(Clone, Debug, Default, PartialEq, Eq)]
enum CornerIndices {
    /// No triangle has the attribute.
    #[default]
    Absent,
    /// Every triangle has the attribute; its indices are those of its positions.
    OfPositions,
    /// The indices for each triangle, or [`NONE`] for a triangle without the attribute.
    Own(Vec<[u32; 3]>),
}

/// The value that is stored instead of indices for a triangle without the attribute.
const NONE: [u32; 3] = [u32::MAX; 3];

/// The bit that marks an index into the values of a piece, which are not appended to those before
/// them yet. All lists have fewer than 2^31 values.
const OF_PIECE: u32 = 1 << 31;

/// Returns the index of a value of a piece, until the piece is appended.
#[cfg_attr(not(feature = "mesh"), allow(dead_code, reason = "only readers read in pieces"))]
pub(super) fn of_piece(index: u32) -> u32 {
    index | OF_PIECE
}

/// Returns the index in a list to which the values of a piece are appended after `base` others.
pub(super) fn index_after(base: u32, index: u32) -> u32 {
    if index & OF_PIECE == 0 { index } else { base + (index & !OF_PIECE) }
}

/// Exchanges the last two corners of each triangle, which turns it inside out.
pub(super) fn reverse_orientation(triangles: &mut [[u32; 3]]) {
    for corners in triangles {
        corners.swap(1, 2);
    }
}

impl<T> Default for Attribute<T> {
    fn default() -> Self {
        Self { values: Vec::new(), corners: CornerIndices::Absent }
    }
}

impl<T: Copy> Attribute<T> {
    /// Returns the attribute with one value for each position.
    pub(super) fn of_positions(values: Vec<T>) -> Self {
        Self { values, corners: CornerIndices::OfPositions }
    }

    /// Returns the attribute with `change` applied to each value.
    pub(super) fn map(self, change: impl FnMut(T) -> T) -> Self {
        Self { values: self.values.into_iter().map(change).collect(), ..self }
    }

    /// Returns the attribute of triangles whose last two corners are exchanged.
    pub(super) fn with_reversed_triangles(mut self) -> Self {
        if let CornerIndices::Own(corners) = &mut self.corners {
            reverse_orientation(corners);
        }
        self
    }

    /// Returns all values, in the order of the file.
    pub fn values(&self) -> &[T] {
        &self.values
    }

    /// Returns the list of values, for adding more.
    pub(super) fn values_mut(&mut self) -> &mut Vec<T> {
        &mut self.values
    }

    /// Returns the indices of the values at a triangle's corners; `None` if it has none.
    pub fn indices_of(&self, triangle: usize, triangles: &[[u32; 3]]) -> Option<[u32; 3]> {
        match &self.corners {
            CornerIndices::Absent => None,
            CornerIndices::OfPositions => triangles.get(triangle).copied(),
            CornerIndices::Own(corners) => corners.get(triangle).copied().filter(|&corner| corner != NONE),
        }
    }

    /// Returns whether any triangle has values.
    pub(super) fn is_of_any(&self) -> bool {
        match &self.corners {
            CornerIndices::Absent => false,
            CornerIndices::OfPositions => true,
            CornerIndices::Own(corners) => corners.iter().any(|&corner| corner != NONE),
        }
    }

    /// Returns the values at a triangle's corners.
    pub(super) fn values_at(&self, triangle: usize, triangles: &[[u32; 3]]) -> Option<[T; 3]> {
        self.indices_of(triangle, triangles).map(|corners| corners.map(|index| self.values[index as usize]))
    }

    /// Adds the values of a triangle's corners and returns their indices.
    pub(super) fn add(&mut self, values: [T; 3]) -> [u32; 3] {
        // There are at most three values per triangle and `MAX_TRIANGLES` triangles, so the index fits into 32 bits.
        let first = self.values.len() as u32;
        self.values.extend(values);
        [first, first + 1, first + 2]
    }

    /// Appends the attribute indices `corner` of the next triangle, whose position indices are
    /// `positions`. `triangles` are the position indices of all triangles before it.
    pub(super) fn push(&mut self, triangles: &[[u32; 3]], positions: [u32; 3], corner: Option<[u32; 3]>) {
        // The first triangle whose indices differ from its positions' changes the representation to `Own`, which then
        // also needs entries for all triangles before it.
        match (&mut self.corners, corner) {
            (CornerIndices::Absent, None) => {}
            (CornerIndices::Absent, Some(corner)) if triangles.is_empty() && corner == positions => {
                self.corners = CornerIndices::OfPositions;
            }
            (CornerIndices::OfPositions, Some(corner)) if corner == positions => {}
            (CornerIndices::Absent, Some(corner)) => {
                let mut own = vec![NONE; triangles.len()];
                own.push(corner);
                self.corners = CornerIndices::Own(own);
            }
            (CornerIndices::OfPositions, _) => {
                let mut own = triangles.to_vec();
                own.push(corner.unwrap_or(NONE));
                self.corners = CornerIndices::Own(own);
            }
            (CornerIndices::Own(own), _) => own.push(corner.unwrap_or(NONE)),
        }
    }

    /// Appends the values and indices of a piece with the triangles `piece_triangles`, whose own
    /// values have the indices of [`of_piece`]. `triangles` are all triangles before it.
    pub(super) fn append(&mut self, mut piece: Self, triangles: &[[u32; 3]], piece_triangles: &[[u32; 3]]) {
        if let CornerIndices::Own(corners) = &mut piece.corners {
            let base = self.values.len() as u32; // fewer than 2^31
            for corner in corners.iter_mut().filter(|corner| **corner != NONE) {
                *corner = corner.map(|index| index_after(base, index));
            }
        }
        self.values.append(&mut piece.values);
        if piece_triangles.is_empty() {
            return;
        }
        let own = |corners, triangles: &[[u32; 3]]| match corners {
            CornerIndices::Absent => vec![NONE; triangles.len()],
            CornerIndices::OfPositions => triangles.to_vec(),
            CornerIndices::Own(own) => own,
        };
        self.corners = match (std::mem::take(&mut self.corners), piece.corners) {
            (_, corners) if triangles.is_empty() => corners,
            (CornerIndices::Absent, CornerIndices::Absent) => CornerIndices::Absent,
            (CornerIndices::OfPositions, CornerIndices::OfPositions) => CornerIndices::OfPositions,
            (before, corners) => {
                let mut all = own(before, triangles);
                all.append(&mut own(corners, piece_triangles));
                CornerIndices::Own(all)
            }
        };
    }

    /// Frees unused capacity, and all values if no triangle refers to one.
    pub(super) fn shrink_to_fit(&mut self) {
        match &mut self.corners {
            CornerIndices::Absent => self.values = Vec::new(),
            CornerIndices::OfPositions => {}
            CornerIndices::Own(corners) => corners.shrink_to_fit(),
        }
        self.values.shrink_to_fit();
    }

    /// Returns whether all indices refer to values, and all values pass the check.
    ///
    /// Triangles without the attribute are valid.
    pub(super) fn is_valid(&self, triangles: &[[u32; 3]], is_valid_value: impl Fn(&T) -> bool) -> bool {
        let in_range = |corner: &[u32; 3]| corner.iter().all(|&index| (index as usize) < self.values.len());
        let corners_are_valid = match &self.corners {
            CornerIndices::Absent => true,
            CornerIndices::OfPositions => triangles.iter().all(in_range),
            CornerIndices::Own(corners) => {
                corners.len() == triangles.len() && corners.iter().all(|corner| *corner == NONE || in_range(corner))
            }
        };
        corners_are_valid && self.values.iter().all(is_valid_value)
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
