//! What `hairpin init ci` writes: a build server's workflow that stresses a scenario.

use std::borrow::Cow;

use hairpin::judgement::is_command;
use thiserror::Error;

/// Why a text is no value of a workflow.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum ValueError {
    /// No scenario.
    #[error("--scenario is empty: must be a file or a name")]
    Empty,
    /// What a command would take for an option.
    #[error("--source `{0}` begins with `-`: must be a Git address")]
    Option(String),
    /// What begins another line, or turns the direction of writing.
    #[error("--{0} has a control character or one that turns the direction of writing: must be one line of text")]
    Command(&'static str),
    /// What a server replaces by a variable, and has no way to write out.
    #[error("--{name} `{value}` has a `$`, which Jenkins takes for a variable: must be without, so name it otherwise")]
    Dollar {
        /// The option.
        name: &'static str,
        /// What was given.
        value: String,
    },
}

/// A build server.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Server {
    /// GitHub Actions.
    Github,
    /// GitLab CI.
    Gitlab,
    /// Jenkins.
    Jenkins,
}

impl Server {
    /// Where the server looks for it in a project.
    pub fn place(self) -> &'static str {
        match self {
            Self::Github => ".github/workflows/hairpin.yml",
            Self::Gitlab => ".gitlab-ci.yml",
            Self::Jenkins => "Jenkinsfile",
        }
    }

    /// The text for `scenario`, with hairpin installed from the Git address `source`; empty where the server has it.
    ///
    /// # Errors
    /// A value that the server, or a command in the workflow, would take for something else.
    pub fn text(self, scenario: &str, source: &str) -> Result<String, ValueError> {
        if scenario.is_empty() {
            return Err(ValueError::Empty);
        }
        if source.starts_with('-') {
            return Err(ValueError::Option(source.into()));
        }
        for (name, value) in [("scenario", scenario), ("source", source)] {
            if value.contains(is_command) {
                return Err(ValueError::Command(name));
            }
            if self == Self::Jenkins && value.contains('$') {
                return Err(ValueError::Dollar { name, value: value.into() });
            }
        }
        // It stands where options do as well.
        let scenario: Cow<str> =
            if scenario.starts_with('-') { format!("./{scenario}").into() } else { scenario.into() };
        let template = match self {
            Self::Github => include_str!("../../../data/ci/github.yml"),
            Self::Gitlab => include_str!("../../../data/ci/gitlab.yml"),
            Self::Jenkins => include_str!("../../../data/ci/Jenkinsfile"),
        };
        let values = [("@SCENARIO@", self.quoted(&scenario)), ("@SOURCE@", self.quoted(source))];
        let mut text = template.replace("@VERSION@", env!("CARGO_PKG_VERSION"));
        // Each once, so that a value which holds another's name keeps it.
        for (name, value) in values.iter().rev() {
            if let Some(at) = text.find(name) {
                text.replace_range(at..at + name.len(), value);
            }
        }
        Ok(text)
    }

    /// `text` as one value: YAML takes JSON's strings, Groovy has its own. What the server would work out in it is
    /// written out: GitHub's `${{ … }}` anywhere, GitLab's `$NAME` in variables.
    fn quoted(self, text: &str) -> String {
        let json = |text: String| serde_json::Value::from(text).to_string();
        match self {
            Self::Github => json(text.replace("${{", "${{ '${{' }}")),
            Self::Gitlab => json(text.replace('$', "$$")),
            Self::Jenkins => {
                let escaped = text.replace('\\', "\\\\").replace('\'', "\\'");
                format!("'{escaped}'")
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_quoted_as_each_server_has_it() {
        let text = |server: Server, scenario: &str| server.text(scenario, "").unwrap();
        let (github, jenkins) = (text(Server::Github, "my \"best\".toml"), text(Server::Jenkins, "o'clock.toml"));
        assert!(github.contains(r#"SCENARIO: "my \"best\".toml""#), "{github}");
        assert!(jenkins.contains(r"SCENARIO = 'o\'clock.toml'"), "{jenkins}");
        for server in [Server::Github, Server::Gitlab, Server::Jenkins] {
            let text = server.text("a.toml", "https://example.org/hairpin.git").unwrap();
            assert!(!text.contains("@VERSION@") && !text.contains("@S"), "{text}");
            assert!(text.contains("https://example.org/hairpin.git"), "{text}");
        }
    }

    /// Servers replace variables in values, and `--foo.toml` would be an option.
    #[test]
    fn values_stay_what_they_are() {
        let line = |server: Server, scenario: &str| {
            let text = server.text(scenario, "").unwrap();
            text.lines().find(|line| line.trim_start().starts_with("SCENARIO")).unwrap().trim_start().to_owned()
        };
        let name = "a${{ github.token }}$HOME.toml";
        assert_eq!(line(Server::Github, name), r#"SCENARIO: "a${{ '${{' }} github.token }}$HOME.toml""#);
        assert_eq!(line(Server::Gitlab, name), r#"SCENARIO: "a$${{ github.token }}$$HOME.toml""#);
        assert_eq!(line(Server::Github, "@SOURCE@"), r#"SCENARIO: "@SOURCE@""#);
        let refused = |server: Server, scenario: &str, source: &str| server.text(scenario, source).unwrap_err();
        assert!(matches!(refused(Server::Jenkins, "a$B.toml", ""), ValueError::Dollar { name: "scenario", .. }));
        assert_eq!(line(Server::Jenkins, "--foo.toml"), "SCENARIO = './--foo.toml'");
        for server in [Server::Github, Server::Gitlab, Server::Jenkins] {
            assert!(line(server, "--foo.toml").contains("./--foo.toml"));
            assert_eq!(refused(server, "", ""), ValueError::Empty);
            assert_eq!(refused(server, "a\n.toml", ""), ValueError::Command("scenario"));
            assert_eq!(refused(server, "a.toml", "\u{202e}"), ValueError::Command("source"));
            assert_eq!(refused(server, "a.toml", "--path=x"), ValueError::Option("--path=x".into()));
        }
    }
}
