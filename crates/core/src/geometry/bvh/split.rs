//! Cuts a set of boxes in two: the surface area heuristic, evaluated at the borders of a few bins along each axis (Wald, On Fast
//! Construction of SAH-based Bounding Volume Hierarchies, 2007).
//!
//! A ray that meets a box meets one inside it with a probability in proportion to its surface, so the cost of a part is its
//! surface times its number of boxes. Cost: linear.

use glam::Vec3A;
use obvhs::aabb::Aabb;

/// Bins along each axis.
const BINS: usize = 32;

/// A triangle as the builder sees it.
#[derive(Clone, Copy, Debug)]
pub struct Item {
    pub bounds: Aabb,
    pub number: u32,
}

/// Reorders `items` so that the first of them, whose number is returned, and the rest have boxes of little surface. Both parts
/// have at least one item if there are two.
pub fn split(items: &mut [Item]) -> usize {
    let bins = Bins::of(items);
    match bins.best() {
        Some((axis, border)) => partition(items, |item| bins.bin(item)[axis] < border),
        None => halves(items),
    }
}

/// Two halves in the order of the items: for items that have the same centre.
pub fn halves(items: &[Item]) -> usize {
    items.len() / 2
}

/// Items in a slice of space.
#[derive(Clone, Copy)]
struct Bin {
    bounds: Aabb,
    count: usize,
}

impl Bin {
    fn empty() -> Bin {
        Bin { bounds: Aabb::empty(), count: 0 }
    }

    fn with(&self, other: &Bin) -> Bin {
        Bin { bounds: self.bounds.union(&other.bounds), count: self.count + other.count }
    }

    fn cost(&self) -> f32 {
        self.bounds.half_area() * self.count as f32
    }
}

/// Items sorted by their centres into slices of equal thickness along each axis.
struct Bins {
    bins: [[Bin; BINS]; 3],
    low: Vec3A,
    scale: Vec3A,
}

impl Bins {
    fn of(items: &[Item]) -> Bins {
        let (mut low, mut high) = (Vec3A::INFINITY, Vec3A::NEG_INFINITY);
        for center in items.iter().map(|item| item.bounds.center()) {
            (low, high) = (low.min(center), high.max(center));
        }
        let mut bins = Bins { bins: [[Bin::empty(); BINS]; 3], low, scale: BINS as f32 / (high - low) };
        for item in items {
            for (axis, bin) in bins.bin(item).into_iter().enumerate() {
                let bin = &mut bins.bins[axis][bin];
                *bin = bin.with(&Bin { bounds: item.bounds, count: 1 });
            }
        }
        bins
    }

    /// The bin of `item` along each axis: the first one where all centres are the same, because NaN becomes zero.
    fn bin(&self, item: &Item) -> [usize; 3] {
        ((item.bounds.center() - self.low) * self.scale).to_array().map(|bin| (bin as usize).min(BINS - 1))
    }

    /// Axis and first bin beyond the border of least cost, if there is one with items on both sides.
    fn best(&self) -> Option<(usize, usize)> {
        let (mut best, mut least) = (None, f32::INFINITY);
        for (axis, bins) in self.bins.iter().enumerate() {
            // What lies beyond each border, from the last one down.
            let mut beyond = [Bin::empty(); BINS + 1];
            for k in (0..BINS).rev() {
                beyond[k] = beyond[k + 1].with(&bins[k]);
            }
            let mut before = Bin::empty();
            for border in 1..BINS {
                before = before.with(&bins[border - 1]);
                let cost = before.cost() + beyond[border].cost();
                if before.count > 0 && beyond[border].count > 0 && cost < least {
                    (best, least) = (Some((axis, border)), cost);
                }
            }
        }
        best
    }
}

/// Brings the items that are `first` to the front; how many there are.
fn partition(items: &mut [Item], first: impl Fn(&Item) -> bool) -> usize {
    let mut end = 0;
    for k in 0..items.len() {
        if first(&items[k]) {
            items.swap(k, end);
            end += 1;
        }
    }
    end
}

#[cfg(test)]
mod tests {
    use super::*;

    fn item(number: u32, center: Vec3A) -> Item {
        Item { bounds: Aabb::new(center - 0.01, center + 0.01), number }
    }

    #[test]
    fn two_clouds_are_cut_apart() {
        for axis in 0..3 {
            let place = |k: u32| {
                let mut center = Vec3A::new((k * 7 % 10) as f32, (k * 3 % 10) as f32, (k * 9 % 10) as f32) * 0.01;
                center[axis] += if k.is_multiple_of(3) { 2.0 } else { 0.0 };
                item(k, center)
            };
            let mut items: Vec<Item> = (0..300).map(place).collect();
            let first = split(&mut items);
            assert_eq!(first, 200);
            assert!(items[..first].iter().all(|item| !item.number.is_multiple_of(3)), "axis {axis}");
        }
    }

    #[test]
    fn items_at_the_same_place_are_halved() {
        let mut items: Vec<Item> = (0..7).map(|k| item(k, Vec3A::ONE)).collect();
        assert_eq!(split(&mut items), 3);
    }
}
