# SPDX-License-Identifier: Apache-2.0
"""What can be imported of launch and launch_ros, by module.

Source: launch and launch_ros jazzy, and launch rolling, ``__all__`` of each package.
"""

from __future__ import annotations

from collections.abc import Mapping

_AMENT = (
    "PackageNotFoundError get_package_prefix get_package_share_directory get_package_share_path "
    "get_packages_with_prefixes"
)
# launch rolling: actions/for_loop.py, log.py; substitutions/for_loop_var.py,
# path_join_substitution.py, string_join_substitution.py.
_NEWER_ACTIONS = "ForEach ForLoop Log LogDebug LogError LogWarning"
_NEWER = "ForEachVar ForLoopIndex PathSubstitution StringJoinSubstitution"
_SOURCES = "get_launch_description_from_python_launch_file load_python_launch_file_as_module"
# What a launch file says by it is read.
READ: Mapping[str, str] = {
    "launch": "Action Condition EventHandler LaunchContext LaunchDescription "
    "LaunchDescriptionSource SomeEntitiesType SomeEntitiesType_types_tuple SomeSubstitutionsType "
    "SomeSubstitutionsType_types_tuple Substitution",
    "launch.actions": f"{_NEWER_ACTIONS} "
    "AppendEnvironmentVariable DeclareLaunchArgument EmitEvent ExecuteLocal "
    "ExecuteProcess GroupAction IncludeLaunchDescription LogInfo OpaqueFunction PopEnvironment "
    "PopLaunchConfigurations PushEnvironment PushLaunchConfigurations RegisterEventHandler "
    "ResetEnvironment ResetLaunchConfigurations SetEnvironmentVariable SetLaunchConfiguration "
    "Shutdown TimerAction UnregisterEventHandler UnsetEnvironmentVariable UnsetLaunchConfiguration",
    "launch.conditions": "IfCondition InvalidConditionExpressionError LaunchConfigurationEquals "
    "LaunchConfigurationNotEquals UnlessCondition evaluate_condition_expression",
    "launch.descriptions": "Executable",
    "launch.event_handlers": "OnExecutionComplete OnIncludeLaunchDescription OnProcessExit "
    "OnProcessIO OnProcessStart OnShutdown",
    "launch.events": "matches_action",
    "launch.frontend": "expose_action expose_substitution",
    "launch.frontend.parse_substitution": "parse_substitution",
    "launch.launch_description_sources": f"AnyLaunchDescriptionSource "
    f"PythonLaunchDescriptionSource {_SOURCES}",
    "launch.logging": "get_logger",
    "launch.substitutions": f"{_NEWER} "
    "AllSubstitution AndSubstitution AnonName AnySubstitution Command "
    "EnvironmentVariable EqualsSubstitution FileContent FindExecutable IfElseSubstitution "
    "LaunchConfiguration LaunchLogDir LocalSubstitution NotEqualsSubstitution NotSubstitution "
    "OrSubstitution PathJoinSubstitution PythonExpression SubstitutionFailure TextSubstitution "
    "ThisLaunchFile ThisLaunchFileDir",
    "launch.utilities": "normalize_to_list_of_substitutions perform_substitutions",
    "launch_ros": "",
    "launch_ros.actions": "ComposableNodeContainer LifecycleNode LifecycleTransition "
    "LoadComposableNodes Node PushROSNamespace PushRosNamespace ROSTimer RosTimer SetParameter "
    "SetParametersFromFile SetROSLogDir SetRemap SetUseSimTime",
    "launch_ros.descriptions": "ComposableNode Parameter ParameterFile ParameterValue",
    "launch_ros.event_handlers": "OnStateTransition",
    "launch_ros.events": "",
    "launch_ros.events.lifecycle": "ChangeState StateTransition",
    "launch_ros.parameter_descriptions": "Parameter ParameterFile ParameterValue",
    "launch_ros.substitutions": "ExecutableInPackage FindPackage FindPackagePrefix FindPackageShare "
    "Parameter",
    "launch_ros.utilities": "evaluate_parameters make_namespace_absolute prefix_namespace",
    "launch_xml": "",
    "launch_xml.launch_description_sources": "XMLLaunchDescriptionSource",
    "launch_yaml": "",
    "launch_yaml.launch_description_sources": "YAMLLaunchDescriptionSource",
    "lifecycle_msgs": "",
    "lifecycle_msgs.msg": "Transition",
    "nav2_common": "",
    "nav2_common.launch": "HasNodeParams LaunchConfigAsBool ParseMultiRobotPose ReplaceString "
    "RewrittenYaml",
    "ament_index_python": _AMENT,
    "ament_index_python.packages": _AMENT,
    "ament_index_python.resources": "get_resource has_resource",
}
# What can be imported: where a launch file needs what it does, a note has its name.
NOT_READ: Mapping[str, str] = {
    "launch": "Event InvalidLaunchFileError LaunchDescriptionEntity LaunchIntrospector LaunchService",
    "launch.actions": "OpaqueCoroutine",
    "launch.event_handlers": "event_named",
    "launch.events": "ExecutionComplete IncludeLaunchDescription Shutdown TimerEvent",
    "launch.events.process": "ProcessExited ProcessIO ProcessStarted ProcessStderr ProcessStdin "
    "ProcessStdout ProcessTargetedEvent RunningProcessEvent ShutdownProcess SignalProcess "
    "matches_executable matches_name matches_pid",
    "launch.frontend": "Entity InvalidFrontendLaunchFileError Parser",
    "launch.launch_description_sources": "FrontendLaunchDescriptionSource "
    "InvalidFrontendLaunchFileError InvalidLaunchFileError InvalidPythonLaunchFileError "
    "get_launch_description_from_any_launch_file get_launch_description_from_frontend_launch_file",
    "launch.logging": "get_output_loggers launch_config reset",
    "launch.utilities": "AsyncSafeSignalManager ensure_argument_type is_a is_a_subclass "
    "isclassinstance normalize_to_list_of_entities visit_all_entities_and_collect_futures",
    "launch.utilities.type_utils": "coerce_to_type get_typed_value is_instance_of is_substitution "
    "normalize_typed_substitution perform_typed_substitution",
    "launch_ros.events": "matches_node_name",
    "launch_ros.events.lifecycle": "matches_node_name",
    "launch_ros.ros_adapters": "ROSAdapter get_ros_adapter get_ros_node",
    "launch_ros.utilities": "add_node_name get_node_name_count "
    "is_namespace_absolute is_root_namespace normalize_parameters "
    "normalize_remap_rule normalize_remap_rules to_parameters_list",
}
# The modules inside of packages that are not called as what is in them.
INSIDE: Mapping[str, str] = {
    "launch.actions": "shutdown_action",
    "launch.conditions": "evaluate_condition_expression_impl",
    "launch.events": "matchers",
    "launch.frontend": "expose type_utils",
    "launch.launch_description_sources": "any_launch_file_utilities frontend_launch_file_utilities "
    "python_launch_file_utilities",
    "launch.substitutions": "boolean_substitution",
    "launch.utilities": "class_tools_impl ensure_argument_type_impl signal_management "
    "normalize_to_list_of_entities_impl normalize_to_list_of_substitutions_impl "
    "perform_substitutions_impl visit_all_entities_and_collect_futures_impl",
    "launch_ros.events": "matchers",
    "launch_ros.events.lifecycle": "lifecycle_node_matchers",
    "launch_ros.utilities": "namespace_utils track_node_names",
}
