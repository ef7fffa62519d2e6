//! The crossings of a tile of lines, sorted along each of them.
//!
//! Crossings come triangle by triangle and stay where they were put. Sorted are keys of 8 bytes, a depth and the number of its
//! crossing: first into a list for each line by counting, then each list by depth (the A-buffer of Carpenter 1984, without its
//! masks). Crossings at equal depth stay in the order of their triangles.
//!
//! Cost: linear but for the sorting of each list, which is short.

use super::Cross;
use super::cover::Row;
use crate::mesh::LANES;
use std::array::from_fn;
use std::ops::Range;

/// Longer lists are sorted by the library.
const SHORT: usize = 24;

/// A triangle that lines meet.
#[derive(Clone, Debug)]
pub struct MetTriangle {
    pub triangle: u32,
    /// Whether they meet its back.
    pub back: bool,
    /// Its points, of all that are covered.
    pub points: Range<usize>,
}

impl MetTriangle {
    /// Its points and as many of those that follow as fill the last [`LANES`] lanes.
    #[inline(always)]
    pub fn chunks(&self) -> Range<usize> {
        self.points.start..self.points.start + self.points.len().next_multiple_of(LANES)
    }
}

/// Points where lines meet triangles, side by side; behind them some that mean nothing.
#[derive(Debug)]
pub struct Points<'a> {
    pub triangles: &'a [MetTriangle],
    /// Distance along the line [m].
    pub t: &'a [f32],
    /// Barycentric coordinates.
    pub u: &'a [f32],
    pub v: &'a [f32],
    /// Room for more about each point.
    pub x: &'a mut [f32],
    pub y: &'a mut [f32],
    pub patch: &'a mut [u32],
    pub front: &'a mut [u32],
    pub further: &'a mut [u32],
}

/// The crossings of one tile, a list for each of its lines, and the working memory to make them.
#[derive(Clone, Debug)]
pub struct TileLists<T> {
    /// Line, distance [m], barycentric coordinates and crossing of each point; beyond `count` whatever was there before.
    lines: Vec<u32>,
    t: Vec<f32>,
    u: Vec<f32>,
    v: Vec<f32>,
    items: Vec<T>,
    count: usize,
    triangles: Vec<MetTriangle>,
    /// Room for more about each point.
    places: [Vec<f32>; 2],
    numbers: [Vec<u32>; 3],
    /// Depth and number of each crossing, in the order of lines, sorted along each.
    keys: Vec<u64>,
    /// Where the list of each line ends among the keys.
    ends: Vec<u32>,
}

impl<T: Copy> TileLists<T> {
    /// Number of lists.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// The crossings of each line, along it.
    pub fn iter(&self) -> impl Iterator<Item = impl ExactSizeIterator<Item = T>> {
        let begins = std::iter::once(0).chain(self.ends.iter().copied());
        let keys = begins.zip(&self.ends).map(|(begin, &end)| &self.keys[begin as usize..end as usize]);
        keys.map(|keys| keys.iter().map(|&key| self.items[key as u32 as usize]))
    }

    /// Forgets all lists and keeps their memory.
    pub fn clear(&mut self) {
        self.count = 0;
        self.triangles.clear();
        self.keys.clear();
        self.ends.clear();
    }

    /// Takes these lists of distances [m] and crossings, each of which is sorted already.
    pub fn fill(&mut self, lists: impl Iterator<Item = impl Iterator<Item = (f32, T)>>) {
        self.clear();
        self.items.clear();
        for list in lists {
            for (t, item) in list {
                self.keys.push(key(t, self.items.len() as u32));
                self.items.push(item);
            }
            self.ends.push(self.keys.len() as u32);
        }
    }

    /// Makes room for `points` more.
    #[inline]
    pub(super) fn reserve(&mut self, points: usize, none: T) {
        let needed = self.count + points + 2 * LANES;
        if self.lines.len().min(self.items.len()) < needed {
            let length = 2 * needed;
            [&mut self.t, &mut self.u, &mut self.v].into_iter().for_each(|values| values.resize(length, 0.0));
            self.places.iter_mut().for_each(|values| values.resize(length, 0.0));
            self.numbers.iter_mut().for_each(|values| values.resize(length, 0));
            self.lines.resize(length, 0);
            self.items.resize(length, none);
        }
    }

    /// Adds the points of a row, of which the first lies on `line`, and the others on those that follow.
    #[inline(always)]
    pub(super) fn push(&mut self, line: i32, row: &Row) {
        // A row has eight points or fewer, mostly: to ask whether it has any would cost more than to take them for some.
        self.put(line, row, 0);
        if row.length > LANES as u32 {
            (LANES..row.length as usize).step_by(LANES).for_each(|k| self.put(line, row, k));
        }
        self.count += row.length as usize;
    }

    /// Writes down the points from the k-th on.
    #[inline(always)]
    fn put(&mut self, line: i32, row: &Row, k: usize) {
        let place = self.count + k;
        let lines: [u32; LANES] = from_fn(|lane| (line + k as i32 + lane as i32) as u32);
        let [t, u, v] = row.points(k as i32);
        let within = place..place + LANES;
        self.lines[within.clone()].copy_from_slice(&lines);
        self.t[within.clone()].copy_from_slice(&t);
        self.u[within.clone()].copy_from_slice(&u);
        self.v[within].copy_from_slice(&v);
    }

    /// Finishes `triangle`, to which all points belong that were added since the last.
    #[inline(always)]
    pub(super) fn finish(&mut self, triangle: u32, back: bool) {
        let start = self.triangles.last().map_or(0, |last| last.points.end);
        if start < self.count {
            self.triangles.push(MetTriangle { triangle, back, points: start..self.count });
        }
    }

    /// Makes crossings of the points.
    #[inline(always)]
    pub(super) fn cross<C: Cross<Crossing = T>>(&mut self, cross: &C) {
        let length = (self.count + LANES).next_multiple_of(LANES).min(self.t.len());
        let [x, y] = self.places.each_mut().map(|values| &mut values[..length]);
        let [patch, front, further] = self.numbers.each_mut().map(|values| &mut values[..length]);
        let (t, u, v) = (&self.t[..length], &self.u[..length], &self.v[..length]);
        let mut points = Points { triangles: &self.triangles, t, u, v, x, y, patch, front, further };
        cross.cross(&mut points, &mut self.items[..length]);
    }

    /// Sorts what there is into `lists` lists.
    #[inline(always)]
    pub(super) fn sort(&mut self, lists: usize) {
        let (lines, t) = (&self.lines[..self.count], &self.t[..self.count]);
        self.ends.clear();
        self.ends.resize(lists, 0);
        lines.iter().for_each(|&line| self.ends[line as usize] += 1);
        // First where each list begins; every key that is put down moves that on, in the end to where the list ends.
        let mut total = 0;
        for end in &mut self.ends {
            (*end, total) = (total, total + *end);
        }
        self.keys.resize(self.count, 0);
        for (number, (&line, &t)) in (0..).zip(lines.iter().zip(t)) {
            let place = &mut self.ends[line as usize];
            self.keys[*place as usize] = key(t, number);
            *place += 1;
        }
        let mut begin = 0;
        for &end in &self.ends {
            sort(&mut self.keys[begin as usize..end as usize]);
            begin = end;
        }
    }
}

/// A number that grows with `t`, and at equal distances with `number`.
#[inline(always)]
fn key(t: f32, number: u32) -> u64 {
    let bits = t.to_bits();
    let ascending = bits ^ ((bits as i32 >> 31) as u32 | 1 << 31);
    u64::from(ascending) << 32 | u64::from(number)
}

/// Sorts a few keys by insertion, without branches that depend on them.
#[inline(always)]
fn sort(keys: &mut [u64]) {
    if keys.len() > SHORT {
        return keys.sort_unstable();
    }
    for k in 1..keys.len() {
        let mut least = keys[k];
        for place in (0..k).rev() {
            let key = keys[place];
            keys[place + 1] = key.max(least);
            least = key.min(least);
        }
        keys[0] = least;
    }
}

impl<T> Default for TileLists<T> {
    fn default() -> TileLists<T> {
        TileLists {
            lines: Vec::new(),
            t: Vec::new(),
            u: Vec::new(),
            v: Vec::new(),
            items: Vec::new(),
            count: 0,
            triangles: Vec::new(),
            places: Default::default(),
            numbers: Default::default(),
            keys: Vec::new(),
            ends: Vec::new(),
        }
    }
}
