//! What `hairpin init ci` writes: a build server's workflow that stresses a scenario.

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
    pub fn text(self, scenario: &str, source: &str) -> String {
        let template = match self {
            Self::Github => include_str!("../../../data/ci/github.yml"),
            Self::Gitlab => include_str!("../../../data/ci/gitlab.yml"),
            Self::Jenkins => include_str!("../../../data/ci/Jenkinsfile"),
        };
        template
            .replace("@VERSION@", env!("CARGO_PKG_VERSION"))
            .replace("@SCENARIO@", &self.quoted(scenario))
            .replace("@SOURCE@", &self.quoted(source))
    }

    /// `text` as one value: YAML takes JSON's strings, Groovy has its own.
    fn quoted(self, text: &str) -> String {
        match self {
            Self::Github | Self::Gitlab => serde_json::Value::from(text).to_string(),
            Self::Jenkins => {
                let escaped = text.replace('\\', "\\\\").replace('\'', "\\'").replace('\n', "\\n");
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
        let (github, jenkins) = (Server::Github.text("my \"best\".toml", ""), Server::Jenkins.text("o'clock.toml", ""));
        assert!(github.contains(r#"SCENARIO: "my \"best\".toml""#), "{github}");
        assert!(jenkins.contains(r"SCENARIO = 'o\'clock.toml'"), "{jenkins}");
        for server in [Server::Github, Server::Gitlab, Server::Jenkins] {
            let text = server.text("a.toml", "https://example.org/hairpin.git");
            assert!(!text.contains("@VERSION@") && !text.contains("@S"), "{text}");
            assert!(text.contains("https://example.org/hairpin.git"), "{text}");
        }
    }
}
