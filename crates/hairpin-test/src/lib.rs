//! `#[test]` of a library that is compiled once for its unit tests and for whoever is tested with it.
//!
//! The compiler's own attribute works in a test harness alone, which is the whole library compiled a second time: of a
//! build for tests that was a third. This one registers the test with the library's `unit_tests`, by which an
//! executable of `tests/` finds all of them. `#[ignore]` and `#[should_panic]` are as they are anywhere.

use proc_macro::{TokenStream, TokenTree};

/// What was said of a test.
#[derive(Default)]
struct Said {
    name: Option<String>,
    ignored: bool,
    /// The literal that its panic has to contain.
    panics_with: Option<String>,
}

/// A test of the library that it stands in.
#[proc_macro_attribute]
pub fn test(_: TokenStream, item: TokenStream) -> TokenStream {
    let mut said = Said::default();
    let mut kept = TokenStream::new();
    let mut tokens = item.into_iter().peekable();
    let mut is_named = false;
    while let Some(token) = tokens.next() {
        if let (TokenTree::Punct(mark), Some(TokenTree::Group(group))) = (&token, tokens.peek())
            && mark.as_char() == '#'
            && said.name.is_none()
            && said.is_of_the_harness(&group.stream())
        {
            tokens.next();
            continue;
        }
        if let TokenTree::Ident(word) = &token {
            if is_named {
                said.name = Some(word.to_string());
            }
            is_named = said.name.is_none() && word.to_string() == "fn";
        }
        kept.extend([token]);
    }
    kept.extend(said.registered());
    kept
}

impl Said {
    /// Whether an attribute is for who runs the tests; takes down what it says.
    fn is_of_the_harness(&mut self, attribute: &TokenStream) -> bool {
        let tokens: Vec<TokenTree> = attribute.clone().into_iter().collect();
        match tokens.first().map(ToString::to_string).as_deref() {
            Some("ignore") => self.ignored = true,
            Some("should_panic") => {
                let literal = match tokens.get(1) {
                    Some(TokenTree::Group(group)) => group.stream().into_iter().last(),
                    _ => tokens.into_iter().nth(2),
                };
                self.panics_with = Some(literal.map_or_else(|| "\"\"".to_owned(), |literal| literal.to_string()));
            }
            _ => return false,
        }
        true
    }

    fn registered(&self) -> TokenStream {
        let Some(name) = &self.name else { return error("`#[test]` is of a function") };
        let panics_with = self.panics_with.as_ref().map_or_else(|| "None".to_owned(), |text| format!("Some({text})"));
        let test = format!(
            "::inventory::submit! {{ crate::unit_tests::UnitTest {{ \
                name: ::core::concat!(::core::module_path!(), \"::{name}\"), \
                run: {name}, ignored: {ignored}, panics_with: {panics_with} }} }}",
            ignored = self.ignored,
        );
        test.parse().unwrap_or_else(|_| error("`#[test]` does not understand this function"))
    }
}

fn error(text: &str) -> TokenStream {
    format!("::core::compile_error!({text:?});").parse().unwrap_or_default()
}
