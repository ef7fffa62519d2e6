//! A cut through the tree of emitters for one receiver: the few groups among which its light rays are distributed.
//!
//! It begins with the root, and the group that is believed to give most is split again and again, so it is fine where the light
//! comes from (after the lightcuts of Walter et al. 2005, with estimates in place of bounds). Groups are chosen in proportion to
//! what they give, emitters within a group to their flux. Both keep their order, so one number that is well distributed over
//! [0, 1) is well distributed over the emitters.

use super::emitter::Emitter;
use super::receiver::Receiver;
use super::tree::Node;

/// Most groups of a cut. More would cost more than the rays they guide.
const MOST: usize = 24;

/// The groups of emitters that light a receiver.
#[derive(Clone, Debug, Default)]
pub struct Cut {
    groups: Vec<Group>,
    /// Working memory: nodes that wait to be split.
    nodes: Vec<(u32, f32)>,
}

#[derive(Clone, Copy, Debug)]
struct Group {
    first: u32,
    end: u32,
    /// Probability of this group, and of all up to it.
    share: f64,
    cumulated: f64,
}

/// An emitter chosen by a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Choice {
    pub emitter: u32,
    pub probability: f64,
    /// What is left of the number: uniform in [0, 1).
    pub rest: f32,
}

impl Cut {
    /// Whether nothing can light the receiver.
    pub fn is_empty(&self) -> bool {
        self.groups.is_empty()
    }

    /// Cuts the tree of `nodes` over `emitters` for `receiver`.
    pub fn make(&mut self, nodes: &[Node], emitters: &[Emitter], receiver: &Receiver) {
        let weight = |node: u32| match &nodes[node as usize] {
            single if single.is_single() => receiver.irradiance(&emitters[single.first as usize]),
            group => group.irradiance(receiver),
        };
        self.nodes.clear();
        self.nodes.extend((!nodes.is_empty()).then(|| (0, weight(0))));
        while self.nodes.len() < MOST {
            let heaviest = (0..self.nodes.len())
                .filter(|&k| self.nodes[k].1 > 0.0 && !nodes[self.nodes[k].0 as usize].is_single())
                .max_by(|&a, &b| self.nodes[a].1.total_cmp(&self.nodes[b].1));
            let Some(k) = heaviest else { break };
            let [left, right] = nodes[self.nodes[k].0 as usize].halves;
            self.nodes[k] = (left, weight(left));
            self.nodes.push((right, weight(right)));
        }
        self.nodes.retain(|&(_, weight)| weight > 0.0);
        self.nodes.sort_unstable_by_key(|&(node, _)| nodes[node as usize].first);
        let total: f64 = self.nodes.iter().map(|&(_, weight)| f64::from(weight)).sum();
        let mut cumulated = 0.0;
        self.groups.clear();
        for &(node, weight) in &self.nodes {
            let (Node { first, end, .. }, share) = (nodes[node as usize], f64::from(weight) / total);
            cumulated += share;
            self.groups.push(Group { first, end, share, cumulated });
        }
    }

    /// The emitter that belongs to `u` in [0, 1). `flux_before[k]` is the flux [lm] of all emitters before emitter k, and that of all
    /// of them at the end.
    pub fn choose(&self, flux_before: &[f64], u: f32) -> Option<Choice> {
        let u = f64::from(u);
        let group = self.groups.iter().find(|group| u < group.cumulated).or(self.groups.last())?;
        let (first, end) = (group.first as usize, group.end as usize);
        let flux = flux_before[end] - flux_before[first];
        let within = ((u + group.share - group.cumulated) / group.share).clamp(0.0, 1.0) * flux + flux_before[first];
        let emitter = first + flux_before[first + 1..end].partition_point(|&before| before <= within);
        let own = flux_before[emitter + 1] - flux_before[emitter];
        let rest = ((within - flux_before[emitter]) / own).clamp(0.0, 1.0 - f64::EPSILON) as f32;
        let rest = rest.min(1.0 - f32::EPSILON);
        Some(Choice { emitter: emitter as u32, probability: group.share * own / flux, rest })
    }

    /// The probability of [`Cut::choose`] for an emitter.
    pub fn probability(&self, flux_before: &[f64], emitter: u32) -> f64 {
        let group = self.groups.partition_point(|group| group.end <= emitter);
        match self.groups.get(group) {
            Some(group) if group.first <= emitter => {
                let flux = |first: u32, end: u32| flux_before[end as usize] - flux_before[first as usize];
                group.share * flux(emitter, emitter + 1) / flux(group.first, group.end)
            }
            _ => 0.0,
        }
    }
}
