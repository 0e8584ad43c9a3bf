"""The arguments of every command. Nothing heavy is imported here, so that help is instant."""
