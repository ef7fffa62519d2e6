//! What a file has and diffuse light does not use, counted, for one sentence at the end.

use std::collections::BTreeMap;

#[derive(Default)]
pub struct Ignored(BTreeMap<String, usize>);

impl Ignored {
    /// Counts one more `what`.
    pub fn note(&mut self, what: &str) {
        self.note_many(what, 1);
    }

    pub fn note_many(&mut self, what: &str, count: usize) {
        if count > 0 {
            *self.0.entry(what.to_owned()).or_default() += count;
        }
    }

    /// The sentence, if there is anything to say.
    pub fn sentence(&self) -> Option<String> {
        let parts: Vec<String> = self.0.iter().map(|(what, count)| format!("{what} ({count})")).collect();
        (!parts.is_empty()).then(|| format!("ignored, with how often it occurs: {}", parts.join(", ")))
    }
}
