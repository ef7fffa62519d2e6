//! Many lists, one a line, of what lies along it, in one piece of memory: what all-hits tracing and rasterisation fill.

use super::Hit;
use std::cmp::Ordering;

/// What has its place along a line.
pub trait Along: Copy {
    /// Which of two things on one line comes first: a total order.
    fn order(&self, other: &Self) -> Ordering;
}

/// By distance, at equal distance by number of the triangle.
impl Along for Hit {
    fn order(&self, other: &Hit) -> Ordering {
        self.t.total_cmp(&other.t).then(self.triangle.cmp(&other.triangle))
    }
}

/// Numbers in lists of their own, as those of the triangles around each of many lines.
impl Along for u32 {
    fn order(&self, other: &u32) -> Ordering {
        self.cmp(other)
    }
}

/// Lists of things along lines. Every finished list is in their order; equals are in the order in which they were given.
#[derive(Clone, Debug, PartialEq)]
pub struct Lists<T> {
    items: Vec<T>,
    /// Where each list ends in `items`.
    ends: Vec<u32>,
}

/// All hits of lines.
pub type HitLists = Lists<Hit>;

impl<T: Along> Lists<T> {
    /// Makes `lists` lists of `fragments`, each a thing and the number of its list, in any order; whatever was there before
    /// is gone. A counting sort: linear. Fragments of a list that does not exist are left out.
    pub fn group(&mut self, lists: usize, fragments: &[(u32, T)]) {
        self.ends.clear();
        self.ends.resize(lists, 0);
        for (list, _) in fragments {
            if let Some(count) = self.ends.get_mut(*list as usize) {
                *count += 1;
            }
        }
        // First where each list begins; every item that is put down moves that on, in the end to where the list ends.
        let mut total = 0;
        for end in &mut self.ends {
            (*end, total) = (total, total + *end);
        }
        let Some(&(_, any)) = fragments.first() else { return self.items.clear() };
        self.items.resize(total as usize, any);
        for (list, item) in fragments {
            if let Some(place) = self.ends.get_mut(*list as usize) {
                self.items[*place as usize] = *item;
                *place += 1;
            }
        }
        let mut begin = 0;
        for &end in &self.ends {
            self.items[begin as usize..end as usize].sort_by(T::order);
            begin = end;
        }
    }

    /// Forgets all lists and keeps their memory.
    pub fn clear(&mut self) {
        self.items.clear();
        self.ends.clear();
    }

    /// Adds an item to the list that is being made.
    pub fn push(&mut self, item: T) {
        self.items.push(item);
    }

    /// Finishes the list that is being made, which may be empty, and begins the next one.
    pub fn finish(&mut self) {
        let begin = self.ends.last().copied().unwrap_or(0);
        self.items[begin as usize..].sort_by(T::order);
        self.ends.push(self.items.len() as u32);
    }

    /// Number of finished lists.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// List number `list`; empty if it does not exist.
    pub fn get(&self, list: usize) -> &[T] {
        let end_of = |list: usize| self.ends.get(list).map_or(self.items.len(), |&end| end as usize);
        &self.items[list.checked_sub(1).map_or(0, end_of)..end_of(list)]
    }

    /// The finished lists.
    pub fn iter(&self) -> impl Iterator<Item = &[T]> {
        let begins = std::iter::once(0).chain(self.ends.iter().copied());
        begins.zip(&self.ends).map(|(begin, &end)| &self.items[begin as usize..end as usize])
    }
}

impl<T> Default for Lists<T> {
    fn default() -> Lists<T> {
        Lists { items: Vec::new(), ends: Vec::new() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hit(t: f32, triangle: u32) -> Hit {
        Hit { t, triangle, ..Hit::MISS }
    }

    #[test]
    fn lists_are_sorted_each_for_itself() {
        let mut pushed = HitLists::default();
        for list in [&[hit(2.0, 5), hit(1.0, 7), hit(1.0, 3)][..], &[], &[hit(0.5, 1)]] {
            list.iter().for_each(|&hit| pushed.push(hit));
            pushed.finish();
        }
        let lists: Vec<&[Hit]> = pushed.iter().collect();
        assert_eq!(lists, [&[hit(1.0, 3), hit(1.0, 7), hit(2.0, 5)][..], &[], &[hit(0.5, 1)]]);
        let fragments = [(0, hit(2.0, 5)), (2, hit(0.5, 1)), (0, hit(1.0, 7)), (3, hit(9.0, 9)), (0, hit(1.0, 3))];
        let mut grouped = HitLists::default();
        // Memory is used again, whatever was in it.
        for few in [5, 1, 0, 5] {
            grouped.group(3, &fragments[..few]);
            assert_eq!(
                (grouped.len(), grouped.iter().map(<[Hit]>::len).sum::<usize>()),
                (3, few.saturating_sub(few / 5))
            );
        }
        assert_eq!(grouped, pushed);
        assert_eq!([0, 1, 2, 3, 9].map(|list| grouped.get(list)), [lists[0], lists[1], lists[2], &[], &[]]);
    }

    /// Items of which some are equal, each with its number.
    #[derive(Clone, Copy, Debug, PartialEq)]
    struct Numbered(u32, usize);

    impl Along for Numbered {
        fn order(&self, other: &Numbered) -> Ordering {
            self.0.cmp(&other.0)
        }
    }

    #[test]
    fn equals_stay_in_their_order() {
        for length in [3, 30, 300] {
            let item = |k: usize| (0, Numbered(k as u32 * 7 % 5, k));
            let fragments: Vec<(u32, Numbered)> = (0..length).map(item).collect();
            let mut lists = Lists::default();
            lists.group(1, &fragments);
            let sorted: Vec<&[Numbered]> = lists.iter().collect();
            assert!(sorted[0].len() == length && sorted[0].is_sorted_by_key(|item| (item.0, item.1)), "{sorted:?}");
        }
    }
}
