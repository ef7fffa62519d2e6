//! A choice from a table of what has a name, such as the sample sequences: written, parsed and stored as the name.

use crate::Error;
use std::fmt;
use std::str::FromStr;

/// A line of such a table.
pub trait TableEntry: Sized + 'static {
    /// What the table has, as an error calls it.
    const KIND: &'static str;
    /// The table; its first line is the default.
    const TABLE: &'static [Self];

    fn name(&self) -> &'static str;
}

/// A line of the table of `E`.
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(try_from = "String", into = "String", bound = "")]
pub struct Choice<E: TableEntry>(pub(crate) &'static E);

impl<E: TableEntry> Choice<E> {
    /// All choices, in the order of the table.
    pub fn all() -> impl Iterator<Item = Choice<E>> {
        E::TABLE.iter().map(Choice)
    }

    /// The line of the table.
    pub fn entry(self) -> &'static E {
        self.0
    }

    pub fn name(self) -> &'static str {
        self.0.name()
    }
}

impl<E: TableEntry> Clone for Choice<E> {
    fn clone(&self) -> Choice<E> {
        *self
    }
}

impl<E: TableEntry> Copy for Choice<E> {}

impl<E: TableEntry> Default for Choice<E> {
    fn default() -> Choice<E> {
        Choice(&E::TABLE[0])
    }
}

impl<E: TableEntry> FromStr for Choice<E> {
    type Err = Error;

    /// # Errors
    /// [`Error::UnknownName`] with the nearest name of the table.
    fn from_str(name: &str) -> Result<Choice<E>, Error> {
        let found = Choice::all().find(|choice: &Choice<E>| choice.name() == name);
        found.ok_or_else(|| Error::unknown_name(E::KIND, name, E::TABLE.iter().map(E::name)))
    }
}

impl<E: TableEntry> TryFrom<String> for Choice<E> {
    type Error = Error;

    fn try_from(name: String) -> Result<Choice<E>, Error> {
        name.parse()
    }
}

impl<E: TableEntry> From<Choice<E>> for String {
    fn from(choice: Choice<E>) -> String {
        choice.name().to_owned()
    }
}

impl<E: TableEntry> fmt::Display for Choice<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl<E: TableEntry> fmt::Debug for Choice<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl<E: TableEntry> PartialEq for Choice<E> {
    fn eq(&self, other: &Choice<E>) -> bool {
        self.name() == other.name()
    }
}

impl<E: TableEntry> Eq for Choice<E> {}

#[cfg(test)]
pub mod tests {
    use super::*;
    use serde::Deserialize;
    use serde::de::IntoDeserializer;
    use std::path::Path;

    /// Holds that the files of `folder`, in the sources, are those of the table: but for those that are no members of it.
    pub fn assert_every_file_is_in_the_table<E: TableEntry>(folder: &str, no_members: &[&str]) {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src").join(folder);
        let files = std::fs::read_dir(folder).unwrap().map(|file| file.unwrap().file_name().into_string().unwrap());
        let mut members: Vec<String> = files
            .filter_map(|file| file.strip_suffix(".rs").map(|stem| stem.replace('_', "-")))
            .filter(|stem| !no_members.contains(&stem.as_str()))
            .collect();
        let mut names: Vec<&str> = E::TABLE.iter().map(E::name).collect();
        members.sort_unstable();
        names.sort_unstable();
        assert_eq!(members, names);
    }

    /// Holds that every choice is parsed, written and stored as its name.
    pub fn assert_named<E: TableEntry>() {
        for choice in Choice::<E>::all() {
            let name = choice.name();
            assert_eq!((name.parse(), stored(name), String::from(choice)), (Ok(choice), Ok(choice), name.to_owned()));
            assert_eq!(Choice::<E>::all().filter(|other| *other == choice).count(), 1, "{name}");
        }
        assert_eq!(Choice::<E>::default().to_string(), E::TABLE[0].name());
    }

    fn stored<E: TableEntry>(name: &'static str) -> Result<Choice<E>, serde::de::value::Error> {
        Choice::deserialize(IntoDeserializer::<serde::de::value::Error>::into_deserializer(name))
    }

    struct Fruit(&'static str);

    impl TableEntry for Fruit {
        const KIND: &'static str = "fruit";
        const TABLE: &'static [Fruit] = &[Fruit("apple"), Fruit("pear"), Fruit("plum")];

        fn name(&self) -> &'static str {
            self.0
        }
    }

    #[test]
    fn names_are_parsed_stored_and_helped_with() {
        assert_named::<Fruit>();
        let error = "appel".parse::<Choice<Fruit>>().unwrap_err().to_string();
        assert_eq!(error, "there is no fruit called 'appel'; did you mean 'apple'?");
        assert!(stored::<Fruit>("plumm").unwrap_err().to_string().contains("did you mean 'plum'?"));
    }
}
