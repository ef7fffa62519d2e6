//! Sets that are joined pair by pair (union-find): which things hang together, however long the chain between them.

/// Disjoint sets of the numbers `0..n`. Each is known by its least member.
#[derive(Clone, Debug, Default)]
pub struct DisjointSets {
    /// A member of the same set that is no larger; the least one leads to itself.
    parents: Vec<u32>,
}

impl DisjointSets {
    /// `n` sets of one member each.
    pub fn new(n: usize) -> DisjointSets {
        DisjointSets { parents: (0..n as u32).collect() }
    }

    /// Adds a set of one new member.
    pub fn push(&mut self) {
        self.parents.push(self.parents.len() as u32);
    }

    /// The least member of the set that `k` is in. The way there is shortened for the next time.
    pub fn least(&mut self, mut k: u32) -> u32 {
        while self.parents[k as usize] != k {
            let beyond = self.parents[self.parents[k as usize] as usize];
            self.parents[k as usize] = beyond;
            k = beyond;
        }
        k
    }

    /// Makes one set of those that `a` and `b` are in.
    pub fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.least(a), self.least(b));
        self.parents[a.max(b) as usize] = a.min(b);
    }

    /// For each number the number of its set, in the order of their least members; and how many sets there are.
    pub fn numbered(mut self) -> (Vec<u32>, u32) {
        let mut numbers: Vec<u32> = Vec::with_capacity(self.parents.len());
        let mut count = 0;
        for k in 0..self.parents.len() as u32 {
            let least = self.least(k);
            if least == k {
                numbers.push(count);
                count += 1;
            } else {
                numbers.push(numbers[least as usize]);
            }
        }
        (numbers, count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chains_are_one_set_in_whatever_order_they_were_joined() {
        let mut sets = DisjointSets::new(6);
        [(4, 5), (1, 3), (5, 1)].into_iter().for_each(|(a, b)| sets.join(a, b));
        sets.push();
        assert_eq!((0..7).map(|k| sets.least(k)).collect::<Vec<u32>>(), [0, 1, 2, 1, 1, 1, 6]);
        assert_eq!(sets.numbered(), (vec![0, 1, 2, 1, 1, 1, 3], 4));
    }
}
