//! Solving with the factor: down its tree, and up again.

use crate::sparse::factor::Factor;
use crate::sparse::panel::{RHS, Row};
use crate::sparse::parallel::map_items;
use crate::sparse::symbolic::{Supernode, Symbolic};
use std::ops::Range;

impl Factor<'_> {
    /// Solves for `count` right-hand sides, which lie row by row in `x`, `count` numbers
    /// per unknown; `x` receives the solutions.
    pub(crate) fn solve(&self, x: &mut [f64], count: usize) {
        if let (RHS, (rows, [])) = (count, x.as_chunks_mut()) {
            self.solve_rows(rows);
            return;
        }
        let mut rows = vec![[0.0; RHS]; self.symbolic.unknowns()];
        for from in (0..count).step_by(RHS) {
            let some = RHS.min(count - from);
            for (row, x) in rows.iter_mut().zip(x.chunks_exact(count)) {
                row[..some].copy_from_slice(&x[from..from + some]);
            }
            self.solve_rows(&mut rows);
            for (row, x) in rows.iter().zip(x.chunks_exact_mut(count)) {
                x[from..from + some].copy_from_slice(&row[..some]);
            }
        }
    }

    fn solve_rows(&self, x: &mut [Row]) {
        let beyond = self.each_subtree(x, |part, k| {
            for s in self.range(k) {
                self.forward(s, part);
            }
        });
        for (&root, beyond) in self.subtrees.iter().zip(&beyond) {
            let mut beyond = beyond.iter();
            for &group in &self.symbolic.supernodes[root].rows {
                let rows = &mut x[self.symbolic.rows(group as usize)];
                rows.iter_mut().zip(&mut beyond).for_each(|(x, v)| add(x, v));
            }
        }
        self.solve_top(x);
        let roots = self.subtrees.iter().map(|&root| &self.symbolic.supernodes[root]);
        let beyond: Vec<Vec<Row>> = roots
            .map(|root| {
                let rows = root.rows.iter();
                let rows = rows.map(|&group| &x[self.symbolic.rows(group as usize)]);
                rows.flatten().copied().collect()
            })
            .collect();
        self.each_subtree(x, |part, k| {
            part.beyond.clone_from(&beyond[k]);
            for s in self.range(k).rev() {
                self.backward(s, part);
            }
        });
    }

    /// Forward and backward on the top, whose supernodes wait for each other.
    fn solve_top(&self, x: &mut [Row]) {
        let nodes = || self.top.iter().map(|&s| &self.symbolic.supernodes[s]);
        let at = |node: &Supernode| {
            let from = self.symbolic.start[node.first];
            from..from + node.width
        };
        let mut part = Part::new(self.symbolic);
        part.local = vec![0; self.symbolic.place.len()];
        let mut count = 0;
        for group in nodes().flat_map(|node| node.first..node.end) {
            part.local[group] = count as u32;
            count += self.symbolic.size(group);
        }
        part.beyond.reserve_exact(count);
        part.beyond.extend(nodes().flat_map(|node| &x[at(node)]));
        self.top.iter().for_each(|&s| self.forward(s, &mut part));
        self.top.iter().rev().for_each(|&s| self.backward(s, &mut part));
        nodes().flat_map(at).zip(part.beyond).for_each(|(row, solved)| x[row] = solved);
    }

    /// Runs `task` on the part of `x` that belongs to each subtree; returns what each
    /// leaves for the unknowns beyond it.
    fn each_subtree(
        &self,
        x: &mut [Row],
        task: impl Fn(&mut Part, usize) + Sync,
    ) -> Vec<Vec<Row>> {
        let (symbolic, nodes) = (self.symbolic, &self.symbolic.supernodes);
        let groups = |k: usize| {
            let range = self.range(k);
            nodes[range.start].first..nodes[range.end - 1].end
        };
        let mut by_place: Vec<usize> = (0..self.subtrees.len()).collect();
        by_place.sort_by_key(|&k| self.subtrees[k]);
        let (mut rest, mut cut) = (x, 0);
        let mut owns: Vec<&mut [Row]> =
            self.subtrees.iter().map(|_| [].as_mut()).collect();
        for k in by_place {
            let [from, to] =
                [groups(k).start, groups(k).end].map(|group| symbolic.start[group]);
            let own;
            (own, rest) = rest.split_at_mut(to - cut);
            owns[k] = &mut own[from - cut..];
            cut = to;
        }
        map_items(
            self.threads,
            owns.into_iter().enumerate(),
            || (vec![0; symbolic.place.len()], Vec::new()),
            |(local, scratch), (k, own)| {
                let mut part = Part::new(symbolic);
                (part.local, part.scratch) =
                    (std::mem::take(local), std::mem::take(scratch));
                part.enter(&nodes[self.subtrees[k]]);
                part.groups = groups(k);
                part.own = own;
                task(&mut part, k);
                (*local, *scratch) = (part.local, part.scratch);
                part.beyond
            },
        )
    }

    fn forward(&self, s: usize, part: &mut Part) {
        let node = &self.symbolic.supernodes[s];
        let mut rows = std::mem::take(&mut part.scratch);
        rows.clear();
        rows.extend_from_slice(part.unknowns(node));
        rows.resize(node.width + node.below, [0.0; RHS]);
        self.columns(s).forward(&mut rows);
        let (solved, mut rest) = rows.split_at(node.width);
        part.unknowns(node).copy_from_slice(solved);
        for &group in &node.rows {
            let into = part.rows(group as usize);
            let values;
            (values, rest) = rest.split_at(into.len());
            into.iter_mut().zip(values).for_each(|(x, v)| add(x, v));
        }
        part.scratch = rows;
    }

    fn backward(&self, s: usize, part: &mut Part) {
        let node = &self.symbolic.supernodes[s];
        let mut rows = std::mem::take(&mut part.scratch);
        rows.clear();
        rows.extend_from_slice(part.unknowns(node));
        for &group in &node.rows {
            rows.extend_from_slice(part.rows(group as usize));
        }
        self.columns(s).backward(&mut rows);
        part.unknowns(node).copy_from_slice(&rows[..node.width]);
        part.scratch = rows;
    }
}

/// Unknowns of some successive groups, and of those beyond that these touch.
struct Part<'a> {
    symbolic: &'a Symbolic,
    groups: Range<usize>,
    own: &'a mut [Row],
    beyond: Vec<Row>,
    /// By group beyond, where its rows begin.
    local: Vec<u32>,
    /// The rows of one supernode.
    scratch: Vec<Row>,
}

impl<'a> Part<'a> {
    fn new(symbolic: &'a Symbolic) -> Self {
        let (own, groups) = ([].as_mut(), 0..0);
        let (beyond, local, scratch) = (Vec::new(), Vec::new(), Vec::new());
        Self { symbolic, groups, own, beyond, local, scratch }
    }

    /// Makes room for what the subtree of `root` touches beyond itself.
    fn enter(&mut self, root: &Supernode) {
        let mut at = 0;
        for &group in &root.rows {
            self.local[group as usize] = at as u32;
            at += self.symbolic.size(group as usize);
        }
        self.beyond.resize(at, [0.0; RHS]);
    }

    /// The rows of a group.
    fn rows(&mut self, group: usize) -> &mut [Row] {
        self.some(group, self.symbolic.size(group))
    }

    /// The rows that a supernode eliminates.
    fn unknowns(&mut self, node: &Supernode) -> &mut [Row] {
        self.some(node.first, node.width)
    }

    fn some(&mut self, group: usize, count: usize) -> &mut [Row] {
        if group < self.groups.end {
            let first = self.symbolic.start[self.groups.start];
            let at = self.symbolic.start[group] - first;
            &mut self.own[at..at + count]
        } else {
            let at = self.local[group] as usize;
            &mut self.beyond[at..at + count]
        }
    }
}

fn add(into: &mut Row, values: &Row) {
    into.iter_mut().zip(values).for_each(|(x, v)| *x += v);
}
