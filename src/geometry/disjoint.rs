//! Which things hang together (Tarjan, Efficiency of a good but not linear set union
//! algorithm, 1975; with path halving).

/// The numbers from 0 on in sets, each set named by its smallest number.
///
/// ```
/// use finwright::geometry::DisjointSets;
/// let mut sets = DisjointSets::new(4);
/// sets.join(3, 1);
/// assert_eq!(sets.first_of(3), 1);
/// assert_eq!(sets.firsts(), [0, 1, 2]);
/// ```
#[derive(Debug, Clone)]
pub struct DisjointSets {
    toward_first: Vec<usize>,
}

impl DisjointSets {
    /// Every number below `count` alone in its set.
    pub fn new(count: usize) -> Self {
        Self { toward_first: (0..count).collect() }
    }

    /// The smallest number in the set of this one.
    pub fn first_of(&mut self, mut k: usize) -> usize {
        while self.toward_first[k] != k {
            self.toward_first[k] = self.toward_first[self.toward_first[k]];
            k = self.toward_first[k];
        }
        k
    }

    /// Makes one set of the sets of two numbers.
    pub fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.first_of(a), self.first_of(b));
        self.toward_first[a.max(b)] = a.min(b);
    }

    /// The smallest number of each set, ascending.
    pub fn firsts(&self) -> Vec<usize> {
        (0..self.toward_first.len()).filter(|&k| self.toward_first[k] == k).collect()
    }
}
