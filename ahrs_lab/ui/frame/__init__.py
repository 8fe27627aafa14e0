"""What stands around every page: navigation, context, health of the bench, STOP."""
