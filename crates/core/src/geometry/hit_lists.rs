//! Many lists of hits, one a line, in one piece of memory: what all-hits tracing fills.

use super::Hit;

/// Lists of hits. Every finished list is in the order of distance, hits at equal distance in the order of their triangles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HitLists {
    hits: Vec<Hit>,
    /// Where each list ends in `hits`.
    ends: Vec<usize>,
}

impl HitLists {
    /// `lists` lists made of `fragments`, each a hit and the number of its list, in any order. A counting sort: linear.
    /// Fragments of a list that does not exist are left out.
    pub fn grouped(lists: usize, fragments: &[(u32, Hit)]) -> HitLists {
        let mut ends = vec![0; lists];
        let known = || fragments.iter().filter(|(list, _)| (*list as usize) < lists);
        known().for_each(|(list, _)| ends[*list as usize] += 1);
        // First where each list begins; every hit that is put down moves that on, in the end to where the list ends.
        let mut total = 0;
        for end in &mut ends {
            (*end, total) = (total, total + *end);
        }
        let mut hits = vec![Hit::MISS; total];
        for (list, hit) in known() {
            let place = &mut ends[*list as usize];
            hits[*place] = *hit;
            *place += 1;
        }
        let mut begin = 0;
        for &end in &ends {
            sort(&mut hits[begin..end]);
            begin = end;
        }
        HitLists { hits, ends }
    }

    /// Forgets all lists and keeps their memory.
    pub fn clear(&mut self) {
        self.hits.clear();
        self.ends.clear();
    }

    /// Adds a hit to the list that is being made.
    pub fn push(&mut self, hit: Hit) {
        self.hits.push(hit);
    }

    /// Finishes the list that is being made, which may be empty, and begins the next one.
    pub fn finish(&mut self) {
        let begin = self.ends.last().copied().unwrap_or(0);
        sort(&mut self.hits[begin..]);
        self.ends.push(self.hits.len());
    }

    /// Number of finished lists.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// The finished lists.
    pub fn iter(&self) -> impl Iterator<Item = &[Hit]> {
        let begins = std::iter::once(0).chain(self.ends.iter().copied());
        begins.zip(&self.ends).map(|(begin, &end)| &self.hits[begin..end])
    }
}

fn sort(hits: &mut [Hit]) {
    hits.sort_unstable_by(|a, b| a.t.total_cmp(&b.t).then(a.triangle.cmp(&b.triangle)));
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
        assert_eq!(HitLists::grouped(3, &fragments), pushed);
    }
}
