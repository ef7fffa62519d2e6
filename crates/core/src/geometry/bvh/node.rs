//! How the tree lies in memory: nodes of eight boxes and leaves of four triangles, coordinates side by side so that one
//! load takes the same coordinate of all of them.

use crate::geometry::NONE;
use glam::Vec3;

/// Children of a node.
pub const WIDTH: usize = 8;
/// Triangles of a leaf.
pub const LEAF_SIZE: usize = 4;

/// Nodes and leaves; node 0 is the root. Children come after their parents.
#[derive(Clone, Debug)]
pub struct Tree {
    pub nodes: Vec<Node>,
    pub leaves: Vec<Leaf>,
    /// No traversal ever has more children waiting than this.
    pub stack_size: usize,
}

impl Tree {
    pub fn bytes(&self) -> usize {
        size_of_val(self.nodes.as_slice()) + size_of_val(self.leaves.as_slice())
    }
}

/// Eight boxes and what is in them.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub struct Node {
    /// `planes[axis][0]` are the lower bounds of the boxes along that axis [m], `planes[axis][1]` the upper ones.
    pub planes: [[[f32; WIDTH]; 2]; 3],
    pub children: [Child; WIDTH],
}

impl Node {
    /// Eight boxes without inside, which no ray hits.
    pub const EMPTY: Node =
        Node { planes: [[[f32::INFINITY; WIDTH], [f32::NEG_INFINITY; WIDTH]]; 3], children: [Child::ROOT; WIDTH] };

    pub fn set_box(&mut self, child: usize, (low, high): (Vec3, Vec3)) {
        for axis in 0..3 {
            self.planes[axis][0][child] = low[axis];
            self.planes[axis][1][child] = high[axis];
        }
    }

    /// The box around all eight.
    pub fn bounds(&self) -> (Vec3, Vec3) {
        let least = |axis: usize| self.planes[axis][0].iter().copied().fold(f32::INFINITY, f32::min);
        let greatest = |axis: usize| self.planes[axis][1].iter().copied().fold(f32::NEG_INFINITY, f32::max);
        (Vec3::from_array([0, 1, 2].map(least)), Vec3::from_array([0, 1, 2].map(greatest)))
    }
}

/// The number of a node, or of a leaf (highest bit set).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Child(u32);

impl Child {
    pub const ROOT: Child = Child(0);
    const LEAF: u32 = 1 << 31;

    pub fn node(index: usize) -> Child {
        Child(index as u32)
    }

    pub fn leaf(index: usize) -> Child {
        Child(index as u32 | Child::LEAF)
    }

    #[inline(always)]
    pub fn is_leaf(self) -> bool {
        self.0 & Child::LEAF != 0
    }

    #[inline(always)]
    pub fn index(self) -> usize {
        (self.0 & !Child::LEAF) as usize
    }
}

/// Up to four triangles.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub struct Leaf {
    /// `corners[corner][axis]` of the four triangles [m]. Where there is no triangle they are NaN, and NaN passes no test.
    pub corners: [[[f32; LEAF_SIZE]; 3]; 3],
    pub triangles: [u32; LEAF_SIZE],
}

impl Leaf {
    pub const EMPTY: Leaf = Leaf { corners: [[[f32::NAN; LEAF_SIZE]; 3]; 3], triangles: [NONE; LEAF_SIZE] };

    pub fn set_triangle(&mut self, lane: usize, number: u32, corners: [Vec3; 3]) {
        self.triangles[lane] = number;
        for (corner, position) in corners.into_iter().enumerate() {
            for axis in 0..3 {
                self.corners[corner][axis][lane] = position[axis];
            }
        }
    }
}
